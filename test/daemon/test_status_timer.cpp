// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>

#include <catch2/catch.hpp>

#include "daemon/report/status_timer.hpp"

using namespace cremed;

namespace {

constexpr std::int64_t kMs = 1000;

/// Number of statuses in `seconds` when two clocks advance alternately each millisecond.
int statuses(std::int64_t apart_us, int seconds) {
  StatusTimer timer;
  int count = 0;
  for (std::int64_t now_us = 0; now_us < seconds * 1000 * kMs; now_us += kMs) {
    for (const std::size_t clock : {std::size_t{0}, std::size_t{1}}) {
      if (timer.is_due(clock, now_us + (clock == 0 ? 0 : apart_us))) {
        timer.restart(clock);
        ++count;
      }
    }
  }
  return count;
}

}  // namespace

TEST_CASE("A status a second, however far apart the clocks are") {
  const auto apart_s = GENERATE(0, 1, 3, -3, 10, -3600);
  CAPTURE(apart_s);
  const int count = statuses(apart_s * 1000 * kMs, 50);
  CHECK(count >= 49);
  CHECK(count <= 51);
}

TEST_CASE("A clock that is set does not silence the status, nor multiply it") {
  const auto step_s = GENERATE(-3600, 3600);
  StatusTimer timer;
  int count = 0;
  for (std::int64_t i = 0; i < 10'000; ++i) {
    if (timer.is_due(0, i * kMs + (i >= 5500 ? step_s * 1000 * kMs : 0))) {
      timer.restart(0);
      ++count;
    }
  }
  CHECK(count == 10);
}

TEST_CASE("A status a second also where each of four buses has a frame a second") {
  StatusTimer timer;
  int count = 0;
  for (std::int64_t i = 0; i < 4 * 50; ++i) {
    const std::size_t clock = i % 4;
    if (timer.is_due(clock, i * 250 * kMs)) {
      timer.restart(clock);
      ++count;
    }
  }
  CHECK(count == 50);
}
