// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/laboratory/pairs/pairs_evaluation.hpp"
#include "tools/laboratory/table/published_figures.hpp"
#include "tools/laboratory/table/simulated_pairs.hpp"

namespace cremed {

/// Size of the evaluation; 0: the paper's.
struct PaperTableOptions {
  std::size_t sets = 0;
  std::size_t runs = 0;
  std::uint64_t seed = 1;
  unsigned threads = 1;
};

/// One method on one simulated problem, with the paper's figures and the bound of known
/// correspondences on the same pairs.
struct TableRow : PairsFigures {
  std::string_view problem;
  std::string_view method;
  Figures paper;
  Figures bound;
};

/// All problems with all methods. All figures but the times depend on sets, runs and seed only.
std::vector<TableRow> paper_table(const PaperTableOptions& options);

}  // namespace cremed
