// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/eval/chi_square.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/laboratory/table/published_figures.hpp"
#include "tools/laboratory/table/simulated_pairs.hpp"

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

/// Size of the evaluation; 0: the paper's.
struct PaperTableOptions {
  std::size_t sets = 0;
  std::size_t runs = 0;
  std::uint64_t seed = 1;
  unsigned threads = 1;
};

/// One method on one simulated problem, with the paper's figures and the bound of known
/// correspondences on the same pairs.
struct TableRow {
  std::string_view problem;
  std::string_view method;
  int degrees_of_freedom = 0;
  std::size_t count = 0;  ///< Estimates.
  Figures ours;
  Interval consistent;  ///< 95 % interval of the ANEES of consistent estimators.
  double iterations = 0.0;
  double milliseconds = 0.0;       ///< Per pair, of one processor.
  std::size_t left_out = 0;        ///< Pairs without an estimate.
  std::size_t ambiguous = 0;       ///< Of these, pairs where another motion fits as well.
  std::size_t no_convergence = 0;  ///< Estimates whose search did not converge.
  std::size_t gross = 0;           ///< Estimates with NEES > kGrossNees.
  Figures paper;
  Figures bound;
  NeesHistogram nees;
};

/// A consistent estimate of 3 (2) DoF exceeds it with probability 2e-5 (4e-6).
inline constexpr double kGrossNees = 25.0;

/// All problems with all methods. All figures but the times depend on sets, runs and seed only.
std::vector<TableRow> paper_table(const PaperTableOptions& options);

}  // namespace cremed
