// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Replaces daemon/process/clocks.cpp and daemon/source/clock_watch.cpp in the test that includes
// it: clocks that the test moves. They stand still otherwise, but not before the stamp of anything
// the kernel delivered.

#include <cstdint>
#include <ctime>
#include <utility>

#include "daemon/process/clocks.hpp"
#include "daemon/source/clock_watch.hpp"

namespace cremed {
namespace test {

/// Ahead of the computer's clock, which stamps what the kernel delivers.
inline std::int64_t realtime_ahead_us = 0;
inline std::int64_t monotonic_time_us = 1'000'000'000;
inline bool is_clock_set = false;  ///< Since the last look.

/// The process does not run for a time.
inline void stop_for(std::int64_t duration_us) {
  realtime_ahead_us += duration_us;
  monotonic_time_us += duration_us;
}

}  // namespace test

std::int64_t monotonic_us() { return test::monotonic_time_us; }

std::int64_t realtime_us() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return now.tv_sec * 1'000'000 + now.tv_nsec / 1000 + test::realtime_ahead_us;
}

void sleep_us(std::int64_t duration_us) {
  if (duration_us > 0) {
    test::stop_for(duration_us);
  }
}

ClockWatch::ClockWatch() = default;

bool ClockWatch::was_set() { return std::exchange(test::is_clock_set, false); }

}  // namespace cremed
