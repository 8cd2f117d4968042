// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "daemon/command_line.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/process/usage_error.hpp"

namespace cremed {

/// Runs on the CAN interfaces of the configuration until asked to stop; what is missing (interface,
/// multicast route) is waited for. SIGHUP reads `path` again: a good configuration replaces the one
/// in use, a bad one is told and left alone. Returns the exit status. Throws UsageError if real
/// time is required and not granted, something asked for makes sense in a replay only, a file would
/// be overwritten, or another process runs with the same configuration.
int run_live(const CommandLine& command_line, const std::string& path,
             const Configuration& configuration);

}  // namespace cremed
