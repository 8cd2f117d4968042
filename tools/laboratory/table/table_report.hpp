// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tools/laboratory/table/paper_table.hpp"
#include "tools/laboratory/table/real_table.hpp"

namespace cremed {

/// Prints the rows as aligned columns, "-" if unknown; header lines begin with #.
void print_table(std::FILE* stream, const std::vector<TableRow>& rows);

/// The same for drives.
void print_real_table(std::FILE* stream, const RealTable& table);

/// The rows as CSV, and their NEES histograms as `problem,method,dof,low,count`; an empty cell is
/// unknown. Throws std::runtime_error.
void write_table_csv(const std::string& path, const std::vector<TableRow>& rows);
void write_nees_csv(const std::string& path, const std::vector<TableRow>& rows);

}  // namespace cremed
