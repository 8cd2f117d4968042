// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "daemon/output/multicast_route.hpp"
#include "test/tools/own_network.hpp"

using namespace cremed;

TEST_CASE("The route of one group suffices for it, and the remedy names the URL's own") {
  if (!test::enter_own_network()) {
    WARN("skipped: no network namespace");
    return;
  }
  CHECK(multicast_problem("udpm://239.255.76.67:7667?ttl=0").empty());
  CHECK(multicast_problem("udpm://").empty());
  CHECK_THAT(multicast_problem("udpm://239.1.2.3:7667?ttl=1"),
             Catch::Contains("`ip route add 239.1.2.3/32 dev lo`"));
}
