// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace cremed {

/// Histogram of the normalised estimation error squared (NEES, not divided by the degrees of
/// freedom) with kBins bins; the last one includes everything above.
class NeesHistogram {
 public:
  static constexpr std::size_t kBins = 41;
  static constexpr double kBinWidth = 0.5;

  void add(double nees) {
    const double bin = std::clamp(nees / kBinWidth, 0.0, static_cast<double>(kBins - 1));
    ++counts_.at(static_cast<std::size_t>(bin));
  }
  [[nodiscard]] const std::array<std::size_t, kBins>& counts() const { return counts_; }

 private:
  std::array<std::size_t, kBins> counts_{};
};

}  // namespace cremed
