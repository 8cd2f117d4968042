// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>

#include "daemon/configuration/configuration.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Listens for `seconds` to the interfaces of the configuration, and to other CAN interfaces there
/// are: a radar may be on one of those. Sends nothing. Ends early when `*stop` is set.
Observation observe_live(const Configuration& configuration, double seconds,
                         const volatile std::sig_atomic_t* stop);

}  // namespace cremed
