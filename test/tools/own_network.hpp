// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <string_view>

#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cremed::test {

/// Moves this process into a new network namespace with only lo and a route for LCM's group; false
/// if not permitted.
inline bool enter_own_network() {
  if (::unshare(CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    return false;
  }
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM, 0);
  ifreq interface {};
  std::string_view("lo").copy(interface.ifr_name, IFNAMSIZ - 1);
  interface.ifr_flags = IFF_UP;
  rtentry route{};
  char device[] = "lo";
  const auto address = [](sockaddr& target, in_addr_t value) {
    sockaddr_in in{};
    in.sin_family = AF_INET;
    in.sin_addr.s_addr = htonl(value);
    static_assert(sizeof(in) == sizeof(target));
    std::memcpy(&target, &in, sizeof(in));
  };
  address(route.rt_dst, 0xEFFF4C43);  // 239.255.76.67, LCM's default group
  address(route.rt_genmask, 0xFFFFFFFF);
  route.rt_flags = RTF_UP | RTF_HOST;
  route.rt_dev = device;
  const bool good = ::ioctl(descriptor, SIOCSIFFLAGS, &interface) == 0 &&
                    ::ioctl(descriptor, SIOCADDRT, &route) == 0;
  ::close(descriptor);
  return good;
}

}  // namespace cremed::test
