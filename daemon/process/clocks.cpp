// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/clocks.hpp"

#include <ctime>

namespace cremed {
namespace {

std::int64_t now_us(clockid_t clock) {
  timespec now{};
  ::clock_gettime(clock, &now);
  return now.tv_sec * 1'000'000 + now.tv_nsec / 1000;
}

}  // namespace

std::int64_t monotonic_us() { return now_us(CLOCK_MONOTONIC); }

std::int64_t realtime_us() { return now_us(CLOCK_REALTIME); }

void sleep_us(std::int64_t duration_us) {
  if (duration_us > 0) {
    const timespec duration{0, duration_us * 1000};
    ::nanosleep(&duration, nullptr);
  }
}

}  // namespace cremed
