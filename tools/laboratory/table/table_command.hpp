// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/laboratory/table/drive_table.hpp"
#include "tools/laboratory/table/paper_table.hpp"
#include "tools/laboratory/table/real_table.hpp"

namespace cremed {

/// cremed-eval table: prints the paper's table as text or JSON, and draws it into `picture` unless
/// that is empty. Throws std::runtime_error.
void run_table(const PaperTableOptions& options, const std::string& picture, bool as_json);

/// cremed-eval table --real: the same for drives.
void run_real_table(const RealTableOptions& options, bool as_json);

/// cremed-eval table --drives: prints the tables of recorded drives in tools/eval/README.md, or
/// writes them there.
void run_drive_table(const DriveTableOptions& options, bool write);

}  // namespace cremed
