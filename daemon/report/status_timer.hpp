// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Says when a second has passed, by clocks that need not agree: each counts by itself, so that it
/// does not matter how far apart they are. A longer step than two seconds, either way, is a clock
/// that was set or a log that was paused; it counts nothing.
class StatusTimer {
 public:
  /// One for each interface, and one more for what no frame tells.
  static constexpr std::size_t kNoInterface = kMaxRadars;

  /// Notes the time of one clock. True the first time, and then once a second.
  bool is_due(std::size_t clock, std::int64_t now_us) {
    constexpr std::int64_t kLongestStepUs = 2'000'000;
    Clock& told = clocks_[clock];
    const std::int64_t step_us = now_us - told.last_us;
    const bool counts = told.has_begun && step_us > 0 && step_us <= kLongestStepUs;
    told = {true, now_us, told.elapsed_us + (counts ? step_us : 0)};
    const bool is_first = !has_begun_;
    has_begun_ = true;
    return is_first || told.elapsed_us >= kPeriodUs;
  }

  /// A status was told: the next one is due a second from now, by any clock.
  void restart() {
    for (Clock& clock : clocks_) {
      clock.elapsed_us = 0;
    }
  }

 private:
  static constexpr std::int64_t kPeriodUs = 1'000'000;
  struct Clock {
    bool has_begun = false;
    std::int64_t last_us = 0;
    std::int64_t elapsed_us = 0;
  };

  std::array<Clock, kMaxRadars + 1> clocks_{};
  bool has_begun_ = false;
};

}  // namespace cremed
