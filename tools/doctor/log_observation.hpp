// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "daemon/configuration/configuration.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Observes all buses of a candump log; "-" is standard input. Throws std::runtime_error if it
/// cannot be read or holds no frame.
Observation observe_log(const Configuration& configuration, const std::string& path);

}  // namespace cremed
