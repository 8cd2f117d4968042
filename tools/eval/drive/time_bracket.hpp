// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace cremed {

/// The two neighbours of a time in a table.
struct TimeBracket {
  std::size_t left = 0;
  std::size_t right = 0;  ///< Equal to left if the time is in the table.
  double share = 0.0;     ///< Fraction of the interval from left to right.
};

struct TimeSpan {
  std::int64_t begin_us = 0;
  std::int64_t end_us = 0;
};

/// Median distance of a table's times; 0 of a single one.
inline std::int64_t usual_step_us(const std::vector<std::int64_t>& utime_us) {
  std::vector<std::int64_t> steps_us;
  for (std::size_t i = 1; i < utime_us.size(); ++i) {
    steps_us.push_back(utime_us[i] - utime_us[i - 1]);
  }
  if (steps_us.empty()) {
    return 0;
  }
  const auto middle = steps_us.begin() + static_cast<std::ptrdiff_t>(steps_us.size() / 2);
  std::nth_element(steps_us.begin(), middle, steps_us.end());
  return *middle;
}

/// Times of a table that are farther apart are a gap, which nothing is known of: 0.25 s, or twice
/// the usual distance if that is longer.
inline std::int64_t longest_step_us(const std::vector<std::int64_t>& utime_us) {
  constexpr std::int64_t kLeastUs = 250'000;
  return std::max(kLeastUs, 2 * usual_step_us(utime_us));
}

/// Nothing outside of the table's time; its times must increase.
inline std::optional<TimeBracket> bracket(const std::vector<std::int64_t>& utime_us,
                                          std::int64_t wanted_us) {
  const auto after = std::lower_bound(utime_us.begin(), utime_us.end(), wanted_us);
  if (after == utime_us.end() || (after == utime_us.begin() && *after != wanted_us)) {
    return std::nullopt;
  }
  const auto right = static_cast<std::size_t>(after - utime_us.begin());
  if (utime_us[right] == wanted_us) {
    return TimeBracket{right, right, 0.0};
  }
  const std::size_t left = right - 1;
  return TimeBracket{left, right,
                     static_cast<double>(wanted_us - utime_us[left]) /
                         static_cast<double>(utime_us[right] - utime_us[left])};
}

}  // namespace cremed
