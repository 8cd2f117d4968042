// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// The configuration as text: a table of the radars with mounts in m and degrees, then the input
/// and output of the odometry, and what is sent on the buses. Lines end with '\n'.
std::string configuration_summary(const Configuration& configuration);

/// Valid but unusual settings, one per line.
std::vector<std::string> configuration_doubts(const Configuration& configuration);

/// Logs the configuration of a run: its file, a line per radar, and doubts.
void log_configuration(const std::string& path, const Configuration& configuration);

}  // namespace cremed
