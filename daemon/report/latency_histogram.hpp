// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace cremed {

/// Histogram of durations in microseconds with buckets no wider than 1/16 of their value: quantiles
/// are too large by at most 6 %, never too small; the maximum is exact. Fixed size.
class LatencyHistogram {
 public:
  /// Negative durations (a clock was set back) count as 0.
  void add(std::int64_t duration_us);
  void clear() { *this = {}; }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::int64_t max_us() const { return max_us_; }
  /// Least duration not exceeded by `share` (0..1) of all; 0 if there is none.
  [[nodiscard]] std::int64_t quantile_us(double share) const;

 private:
  static constexpr std::size_t kPerOctave = 16;
  static constexpr std::size_t kBuckets = 32 * kPerOctave;
  static std::size_t bucket_of(std::int64_t duration_us);
  static std::int64_t end_of(std::size_t bucket);

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  std::int64_t max_us_ = 0;
};

}  // namespace cremed
