// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <catch2/catch.hpp>

#include "daemon/configuration/lcm_url.hpp"

using namespace cremed;

TEST_CASE("LCM URLs that can be used at once") {
  const auto url = GENERATE(as<std::string>{}, "none", "udpm://", "udpm://239.255.76.67",
                            "udpm://239.255.76.67:7667", "udpm://239.255.76.67:7667?ttl=0",
                            "udpm://239.1.2.3:1?ttl=255", "udpm://:7667?recv_buf_size=9000&ttl=1",
                            "udpm://?ttl=1", "file:///tmp/a.lcm?mode=w", "memq://");
  CAPTURE(url);
  CHECK(is_lcm_url(url));
}

TEST_CASE("LCM URLs that are refused: other schemes, those that wait, and what IP has not") {
  const auto url = GENERATE(
      as<std::string>{}, "", "me", "239.255.76.67:7667", "udp://239.255.76.67:7667",
      "tcpq://127.0.0.1:7700", "mpudpm://239.255.76.67:7667", "UDPM://239.255.76.67:7667",
      "://239.255.76.67", "udpm:/239.255.76.67", "udpm://239.255.76.67:0", "udpm://10.0.0.1",
      "udpm://10.0.0.1:7667", "udpm://nowhere:7667?ttl=0", "udpm://240.0.0.1:7667",
      "udpm://239.255.76:7667", "udpm://239.255.76.67:65536", "udpm://239.255.76.67:7667x",
      "udpm://239.255.76.67:", "udpm://239.255.76.67:7667?ttl=256",
      "udpm://239.255.76.67:7667?ttl=-1",
      "udpm://239.255.76.67:7667?ttl=", "udpm://239.255.76.67:7667?ttl=a",
      "udpm://239.255.76.67:7667?tll=1", "udpm://239.255.76.67:7667?TTL=1",
      "udpm://239.255.76.67:7667?recv_buf_size=9000&ttl=999", "file:///tmp/a.lcm",
      "file:///tmp/a.lcm?mode=r", "file://?mode=w");
  CAPTURE(url);
  CHECK_FALSE(is_lcm_url(url));
}
