// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// In a network namespace of its own; CAN interfaces that come and go are tested in test/vm.
#include <catch2/catch.hpp>

#include "daemon/source/link_watch.hpp"
#include "test/tools/own_network.hpp"

using namespace cremed;

namespace {

bool set_up(const char* name, bool is_up) {
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq interface {};
  std::string_view(name).copy(interface.ifr_name, IFNAMSIZ - 1);
  interface.ifr_flags = static_cast<short>(is_up ? IFF_UP : 0);
  const bool good = ::ioctl(descriptor, SIOCSIFFLAGS, &interface) == 0;
  ::close(descriptor);
  return good;
}

}  // namespace

TEST_CASE("An interface is followed up and down, and one that is absent is no error") {
  if (!test::enter_own_network()) {
    WARN("skipped: no permission for a network namespace");
    return;
  }
  LinkWatch links;
  CHECK(links.link("lo").index == ::if_nametoindex("lo"));
  CHECK(links.link("lo").is_up);
  for (const bool is_up : {false, true, false, true}) {  // Later cases use it.
    REQUIRE(set_up("lo", is_up));
    CHECK(links.link("lo").is_up != is_up);  // Not before it is asked.
    links.update();
    CHECK(links.link("lo").is_up == is_up);
  }
  for (const char* name : {"", "l", "lo0", "can0"}) {
    CHECK(links.link(name).index == 0);
    CHECK(links.link(name).error == 0);
  }
  CHECK(links.can_names().empty());
}
