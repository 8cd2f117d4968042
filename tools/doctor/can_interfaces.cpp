// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/can_interfaces.hpp"

#include <cerrno>

#include <linux/can.h>
#include <sys/socket.h>

#include "daemon/process/descriptor.hpp"
#include "daemon/source/link_watch.hpp"

namespace cremed {

bool kernel_has_can() {
  const Descriptor socket(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW));
  return socket.is_open() || (errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT);
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
