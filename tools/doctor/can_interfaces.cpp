// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/can_interfaces.hpp"

#include <cerrno>

#include <linux/can.h>
#include <sys/socket.h>
#include <unistd.h>

#include "daemon/source/link_watch.hpp"

namespace cremed {
bool kernel_has_can() {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor >= 0) {
    ::close(descriptor);
    return true;
  }
  return errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT;
}

InterfaceState state_of(const std::string& interface) {
  const Link link = LinkWatch().link(interface);
  if (link.index == 0) {
    return InterfaceState::absent;
  }
  if (!link.is_can) {
    return InterfaceState::not_can;
  }
  if (!link.is_up) {
    return InterfaceState::down;
  }
  return link.has_carrier ? InterfaceState::up : InterfaceState::bus_off;
}

}  // namespace cremed
