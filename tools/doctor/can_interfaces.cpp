// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/can_interfaces.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <linux/can.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace cremed {
namespace {

namespace fs = std::filesystem;

/// Number in a file of one; -1 where it cannot be read, as `carrier` of an interface that is down.
long number_in(const fs::path& file) {
  std::ifstream stream(file);
  stream >> std::setbase(0);
  long number = -1;
  return stream >> number ? number : -1;
}

}  // namespace

std::vector<std::string> can_interfaces(const std::string& sys_class_net) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(sys_class_net, error)) {
    if (number_in(entry.path() / "type") == ARPHRD_CAN) {
      names.push_back(entry.path().filename());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

InterfaceLook look_at(const std::string& interface, const std::string& sys_class_net) {
  const fs::path folder = fs::path(sys_class_net) / interface;
  std::error_code error;
  if (!fs::exists(folder, error)) {
    return {};
  }
  InterfaceLook look;
  look.is_virtual = !fs::exists(folder / "device", error);
  if (number_in(folder / "type") != ARPHRD_CAN) {
    look.state = InterfaceState::not_can;
  } else if ((number_in(folder / "flags") & IFF_UP) == 0) {
    look.state = InterfaceState::down;
  } else {
    // Drivers take the carrier away when their controller goes bus-off.
    look.state = number_in(folder / "carrier") == 0 ? InterfaceState::bus_off : InterfaceState::up;
  }
  return look;
}

bool kernel_has_can() {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor >= 0) {
    ::close(descriptor);
    return true;
  }
  return errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT;
}

}  // namespace cremed
