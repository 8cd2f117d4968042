// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/source/clock_watch.hpp"

#include <cerrno>
#include <cstdint>
#include <limits>

#include <sys/timerfd.h>
#include <unistd.h>

namespace cremed {

ClockWatch::ClockWatch()
    : descriptor_(::timerfd_create(CLOCK_REALTIME, TFD_NONBLOCK | TFD_CLOEXEC)) {
  arm();
}

/// A timer that never expires but is cancelled when the clock is set.
void ClockWatch::arm() {
  itimerspec never{};
  never.it_value.tv_sec = std::numeric_limits<std::int32_t>::max();
  never.it_value.tv_sec *= 2;  // The year 2106.
  if (descriptor_.is_open()) {
    ::timerfd_settime(descriptor_.number(), TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET, &never,
                      nullptr);
  }
}

bool ClockWatch::was_set() {
  std::uint64_t expirations = 0;
  const bool cancelled = descriptor_.is_open() &&
                         ::read(descriptor(), &expirations, sizeof(expirations)) < 0 &&
                         errno == ECANCELED;
  if (cancelled) {
    arm();
  }
  return cancelled;
}

}  // namespace cremed
