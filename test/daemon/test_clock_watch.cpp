// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A clock that is set is tested in test/vm (clock_steps), and what LiveSource makes of it there
// too.
#include <catch2/catch.hpp>

#include "daemon/source/clock_watch.hpp"

using namespace cremed;

TEST_CASE("A clock that runs was not set, however often it is asked") {
  ClockWatch clock;
  REQUIRE(clock.descriptor() >= 0);
  for (int i = 0; i < 3; ++i) {
    CHECK_FALSE(clock.was_set());
  }
}
