// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "daemon/command_line.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Replays the logs of the command line through the pipeline. Returns the exit status: 0, or 1 if
/// input could not be read or was not what it should be (replay_report.hpp), or output was lost;
/// 128 more than the number of the signal that stopped it.
/// Throws UsageError if an output would overwrite an input or another output, std::runtime_error if
/// inputs or outputs cannot be opened.
int run_replay(const CommandLine& command_line, const std::string& configuration_path,
               const Configuration& configuration);

}  // namespace cremed
