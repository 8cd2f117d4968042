// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/doctor/bus_observation.hpp"

namespace cremed {

/// Whether this kernel supports raw CAN sockets.
bool kernel_has_can();

/// The kernel's state of an interface; never `failed`.
InterfaceState state_of(const std::string& interface);

}  // namespace cremed
