// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cremed {

/// Time-averaged NIS: mean of normalised innovations squared, a degree of freedom, over the last
/// minute. 1 where the covariances of the two estimates that are compared are true, above 1 where
/// they are too small. One innovation counts as kMaxInnovation at most: a few wild ones say nothing
/// about all others.
class InnovationMean {
 public:
  /// `utime_us` may go back, which begins anew.
  void add(std::int64_t utime_us, double innovation);
  void clear();
  /// Time passes: forgets what is older than a minute then.
  void pass(std::int64_t utime_us);

  [[nodiscard]] std::uint64_t count() const { return count_; }
  /// 0 without any.
  [[nodiscard]] double mean() const;
  /// Whether there are enough of them to judge by.
  [[nodiscard]] bool is_enough() const { return count_ >= kMinCount; }
  [[nodiscard]] bool exceeds(double limit) const { return is_enough() && mean() > limit; }

 private:
  static constexpr std::size_t kSeconds = 60;
  /// The mean of so many independent ones, of two degrees of freedom each, is 1 +- 0.1.
  static constexpr std::uint64_t kMinCount = 100;
  /// 5 sigma: less likely than 10^-6, so that a true covariance is judged by all of them.
  static constexpr double kMaxInnovation = 25.0;
  struct Second {
    std::uint64_t count = 0;
    double sum = 0.0;
  };

  std::array<Second, kSeconds> seconds_{};
  std::int64_t second_ = 0;  // The newest; of utime.
  std::uint64_t count_ = 0;
};

}  // namespace cremed
