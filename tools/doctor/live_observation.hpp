// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

#include "daemon/configuration/configuration.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Observes for `seconds` the interfaces of the configuration and all other CAN interfaces, where a
/// radar may be by mistake. Sends nothing. Ends early when `*stop` is set.
Observation observe_live(const Configuration& configuration, double seconds,
                         const volatile std::sig_atomic_t* stop);

}  // namespace cremed
