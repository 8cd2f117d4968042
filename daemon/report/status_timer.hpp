// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Reports each passed second, by clocks that may differ: each counts its own steps. A step of more
/// than two seconds in either direction (a clock that was set, a paused log) counts nothing.
class StatusTimer {
 public:
  /// One per interface (one a radar, and the vehicle's), and this for events without a frame.
  static constexpr std::size_t kNoInterface = kMaxRadars + 1;

  /// Notes the time of one clock. True the first time, then once a second.
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

  /// A status was published at a time of this clock: the next is due a second from now, by any
  /// clock. Of the others' present steps, the part that has passed is not known: they do not count.
  void restart(std::size_t clock) {
    for (std::size_t other = 0; other < clocks_.size(); ++other) {
      clocks_[other].elapsed_us = 0;
      clocks_[other].has_begun = clocks_[other].has_begun && other == clock;
    }
  }

 private:
  static constexpr std::int64_t kPeriodUs = 1'000'000;
  struct Clock {
    bool has_begun = false;
    std::int64_t last_us = 0;
    std::int64_t elapsed_us = 0;
  };

  std::array<Clock, kNoInterface + 1> clocks_{};
  bool has_begun_ = false;
};

}  // namespace cremed
