// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <memory>
#include <string>

#include "daemon/configuration/configuration.hpp"
#include "daemon/source/can_socket.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Whether this kernel supports raw CAN sockets.
bool kernel_has_can();

/// The kernel's state of an interface; never `failed`.
InterfaceState state_of(const std::string& interface);

/// Opens a bus, whose interface is named, and notes its state; null if that is not possible. One
/// that is bus-off is opened: it may recover meanwhile.
std::unique_ptr<CanSocket> open_bus(const CanSocketOptions& options, BusObservation& bus);

/// Observes for `seconds` the interfaces of the configuration and all other CAN interfaces, where a
/// radar may be by mistake. Sends nothing. Ends early when `*stop` is set.
Observation observe_live(const Configuration& configuration, double seconds,
                         const volatile std::sig_atomic_t* stop);

}  // namespace cremed
