// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tools/eval/credibility.hpp"
#include "tools/laboratory/table/paper_table.hpp"
#include "tools/laboratory/table/real_table.hpp"

namespace cremed {

/// The result of cremed-eval pairs.
struct PairsFigures {
  std::string method;
  Credibility credibility;
  double iterations = 0.0;  ///< Mean per pair.
  double solve_us = 0.0;    ///< Mean per pair.
  std::size_t no_convergence = 0;
  std::size_t left_out = 0;
};

/// As credibility_json().
std::string pairs_json(const PairsFigures& figures);
std::string table_json(const std::vector<TableRow>& rows);
std::string real_table_json(const RealTable& table);

}  // namespace cremed
