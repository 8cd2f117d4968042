// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "tools/laboratory/table/paper_table.hpp"
#include "tools/laboratory/table/real_table.hpp"

namespace cremed {

/// The result of cremed-eval pairs, as credibility_json().
std::string pairs_json(const std::string& method, const PairsFigures& figures);
/// The results of cremed-eval table.
std::string table_json(const std::vector<TableRow>& rows);
std::string real_table_json(const RealTable& table);

}  // namespace cremed
