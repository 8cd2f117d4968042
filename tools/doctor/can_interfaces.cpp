// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/can_interfaces.hpp"

#include <cerrno>
#include <optional>

#include <linux/can.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cremed {
namespace {

/// Result of an interface request; nothing if the interface does not exist.
std::optional<ifreq> ask(const std::string& interface, unsigned long request) {
  ifreq answer{};
  const int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  interface.copy(answer.ifr_name, IFNAMSIZ - 1);
  const bool is_answered = descriptor >= 0 && ::ioctl(descriptor, request, &answer) == 0;
  ::close(descriptor);
  return is_answered ? std::optional(answer) : std::nullopt;
}

bool is_can(const std::string& interface) {
  const auto answer = ask(interface, SIOCGIFHWADDR);
  return answer && answer->ifr_hwaddr.sa_family == ARPHRD_CAN;
}

}  // namespace

bool kernel_has_can() {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor >= 0) {
    ::close(descriptor);
    return true;
  }
  return errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT;
}

std::vector<std::string> can_interfaces() {
  std::vector<std::string> names;
  struct if_nameindex* const all = ::if_nameindex();
  for (const auto* entry = all; entry != nullptr && entry->if_index != 0; ++entry) {
    if (is_can(entry->if_name)) {
      names.emplace_back(entry->if_name);
    }
  }
  ::if_freenameindex(all);
  return names;
}

InterfaceState state_of(const std::string& interface) {
  const auto answer = ask(interface, SIOCGIFFLAGS);
  if (!answer) {
    return InterfaceState::absent;
  }
  if (!is_can(interface)) {
    return InterfaceState::not_can;
  }
  if ((answer->ifr_flags & IFF_UP) == 0) {
    return InterfaceState::down;
  }
  // Drivers drop the carrier when their controller goes bus-off.
  return (answer->ifr_flags & IFF_RUNNING) == 0 ? InterfaceState::bus_off : InterfaceState::up;
}

}  // namespace cremed
