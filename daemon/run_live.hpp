// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "daemon/command_line.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Runs on the CAN interfaces of the configuration until a stop is requested; waits for missing
/// interfaces and routes. SIGHUP reads `path` again: a valid configuration replaces the one in use,
/// an invalid one is logged and ignored. Returns the exit status. Throws UsageError if real time is
/// required and not granted, an option is for replays only or a file would be overwritten;
/// std::runtime_error if another process uses the same configuration.
int run_live(const CommandLine& command_line, const std::string& path,
             const Configuration& configuration);

/// Throws UsageError if live operation would overwrite the configuration or another's file, or
/// write messages to a file.
void refuse_outputs(const CommandLine& command_line, const std::string& path,
                    const Configuration& configuration);

}  // namespace cremed
