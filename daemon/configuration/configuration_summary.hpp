// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// What was understood, for people: a table of the radars with their mounts in m and degrees, then
/// what the odometry uses, where it goes, and what is sent on the buses. Lines end with '\n'.
std::string configuration_summary(const Configuration& configuration);

/// What is allowed but is rarely meant, a line each.
std::vector<std::string> configuration_doubts(const Configuration& configuration);

/// Logs what a run begins with: its file, a line a radar, and doubts.
void log_configuration(const std::string& path, const Configuration& configuration);

}  // namespace cremed
