// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/report/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cremed {

void LatencyHistogram::add(std::int64_t duration_us) {
  const std::int64_t duration = std::max<std::int64_t>(duration_us, 0);
  ++buckets_[bucket_of(duration)];
  ++count_;
  max_us_ = std::max(max_us_, duration);
}

/// Below kPerOctave a bucket holds one value; above it, an octave has kPerOctave buckets.
std::size_t LatencyHistogram::bucket_of(std::int64_t duration_us) {
  const auto value = static_cast<std::uint64_t>(duration_us);
  if (value < kPerOctave) {
    return value;
  }
  const std::size_t octave = std::bit_width(value / kPerOctave) - 1;
  const std::size_t bucket = octave * kPerOctave + (value >> octave);
  return std::min(bucket, kBuckets - 1);
}

/// Largest value of a bucket.
std::int64_t LatencyHistogram::end_of(std::size_t bucket) {
  if (bucket < kPerOctave) {
    return static_cast<std::int64_t>(bucket);
  }
  const std::size_t octave = bucket / kPerOctave - 1;
  const std::uint64_t first = bucket - octave * kPerOctave;
  return static_cast<std::int64_t>(((first + 1) << octave) - 1);
}

std::int64_t LatencyHistogram::quantile_us(double share) const {
  if (count_ == 0) {
    return 0;
  }
  const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t bucket = 0; bucket < kBuckets; ++bucket) {
    below += buckets_[bucket];
    if (below >= std::max<std::uint64_t>(rank, 1)) {
      return std::min(end_of(bucket), max_us_);
    }
  }
  return max_us_;
}

}  // namespace cremed
