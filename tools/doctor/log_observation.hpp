// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Observes all buses of candump logs, which are those of one drive; "-" is standard input. Throws
/// std::runtime_error if one cannot be read or none holds a frame.
Observation observe_logs(const Configuration& configuration, const std::vector<std::string>& paths);

}  // namespace cremed
