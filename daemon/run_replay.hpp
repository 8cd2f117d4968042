// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/command_line.hpp"
#include "daemon/configuration.hpp"

namespace cremed {

/// Replays the logs of the command line through the pipeline. Returns the exit status: 0, or 1 if
/// input could not be read, held no frame, or output was lost. Throws std::runtime_error if inputs
/// or outputs cannot be opened.
int run_replay(const CommandLine& command_line, const Configuration& configuration);

}  // namespace cremed
