// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <catch2/catch.hpp>

#include "daemon/source/link_watch.hpp"
#include "tools/doctor/live_observation.hpp"

using namespace cremed;

// Tests with real CAN interfaces are in test/vm.
TEST_CASE("An interface of another kind is told from one that is not there") {
  CHECK(state_of("lo") == InterfaceState::not_can);
  CHECK(state_of("cremed-absent") == InterfaceState::absent);
  CHECK(state_of("a name that is longer than any interface's") == InterfaceState::absent);
  const auto names = LinkWatch().can_names();
  CHECK(std::ranges::find(names, "lo") == names.end());
}
