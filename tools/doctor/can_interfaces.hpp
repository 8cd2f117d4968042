// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/doctor/bus_observation.hpp"

namespace cremed {

/// Where the kernel shows its network interfaces.
inline constexpr const char* kSysClassNet = "/sys/class/net";

/// Names of the CAN interfaces there are, sorted.
std::vector<std::string> can_interfaces(const std::string& sys_class_net = kSysClassNet);

struct InterfaceLook {
  InterfaceState state = InterfaceState::absent;
  bool is_virtual = false;
};

InterfaceLook look_at(const std::string& interface,
                      const std::string& sys_class_net = kSysClassNet);

/// Can this kernel open raw CAN sockets?
bool kernel_has_can();

}  // namespace cremed
