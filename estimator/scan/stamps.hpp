// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// Time from one stamp to another. Computed in double so that it cannot overflow; stamps of
/// present-day clocks are exact in double.
inline double seconds_between(std::int64_t from_us, std::int64_t to_us) {
  return (static_cast<double>(to_us) - static_cast<double>(from_us)) * 1e-6;
}

/// Two missing scans. Over a longer pause Doppler is neither interpolated nor summed to a way.
inline constexpr double kMaxScanPeriodS = 0.3;

/// The first whole multiple of 1 / rate_hz s, rounded up to microseconds, after a stamp.
inline std::int64_t next_multiple_us(std::int64_t after_us, std::int64_t rate_hz) {
  constexpr std::int64_t kSecondUs = 1'000'000;
  const std::int64_t into_second_us = (after_us % kSecondUs + kSecondUs) % kSecondUs;
  const std::int64_t count = into_second_us * rate_hz / kSecondUs + 1;
  return after_us - into_second_us + (count * kSecondUs + rate_hz - 1) / rate_hz;
}

}  // namespace cremed
