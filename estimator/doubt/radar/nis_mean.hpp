// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cremed {

/// Mean NIS per degree of freedom over the last minute. It is 1 if the covariances of the two
/// compared estimates are true, above 1 if they are too small. Each NIS is limited to kMaxNis, so
/// that a few outliers do not dominate the mean.
class NisMean {
 public:
  /// If `utime_us` goes back, the mean is cleared.
  void add(std::int64_t utime_us, double nis);
  void clear();
  /// Removes what is older than a minute at `utime_us`.
  void pass(std::int64_t utime_us);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// 0 if there is none.
  [[nodiscard]] double mean() const;
  /// Whether there are enough NIS for a judgement.
  [[nodiscard]] bool is_enough() const { return count_ >= kMinCount; }
  [[nodiscard]] bool exceeds(double limit) const { return is_enough() && mean() > limit; }

 private:
  static constexpr std::size_t kSeconds = 60;
  /// The mean of this many independent NIS of two degrees of freedom is 1 +- 0.1.
  static constexpr std::uint64_t kMinCount = 100;
  /// 5 sigma: exceeded with probability below 10^-6, so the limit does not change the mean of a
  /// true covariance.
  static constexpr double kMaxNis = 25.0;
  struct Second {
    std::uint64_t count = 0;
    double sum = 0.0;
  };

  std::array<Second, kSeconds> seconds_{};
  std::int64_t second_ = 0;  // The newest second.
  std::uint64_t count_ = 0;
};

}  // namespace cremed
