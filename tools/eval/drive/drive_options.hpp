// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>

#include "tools/eval/drive/drive_command.hpp"

namespace cremed {

/// The command line of cremed-eval drive.
/// --truth-std, for commands that compare with truth.
CLI::Option* add_truth_std(CLI::App& command, TruthNoise& noise);

void add_drive(CLI::App& app, DriveFiles& files);

}  // namespace cremed
