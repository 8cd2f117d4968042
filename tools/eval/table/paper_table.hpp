// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/eval/chi_square.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/table/nees_histogram.hpp"
#include "tools/eval/table/published_figures.hpp"
#include "tools/eval/table/simulated_pairs.hpp"

namespace cremed {

/// Size of the evaluation; 0: as many as in the paper.
struct PaperTableOptions {
  std::size_t sets = 0;
  std::size_t runs = 0;
  std::uint64_t seed = 1;
  unsigned threads = 1;
};

/// One method on one simulated problem, with what the paper states and what a registration that
/// knows the correspondences gets out of the same pairs.
struct TableRow {
  std::string_view problem;
  std::string_view method;
  int degrees_of_freedom = 0;
  std::size_t count = 0;  ///< Estimates.
  Figures ours;
  Interval consistent;  ///< 95 % of consistent estimators have their ANEES in it.
  double iterations = 0.0;
  double milliseconds = 0.0;       ///< A pair, of one processor.
  std::size_t left_out = 0;        ///< Pairs without an estimate,
  std::size_t ambiguous = 0;       ///< and how many of them for another motion that fits as well.
  std::size_t no_convergence = 0;  ///< Estimates at which the search had not ended.
  std::size_t gross = 0;           ///< Estimates with NEES > kGrossNees.
  Figures paper;
  Figures bound;
  NeesHistogram nees;
};

/// Chance brings a consistent estimate of 3 (2) DoF above it in 2e-5 (4e-6) of all cases.
inline constexpr double kGrossNees = 25.0;

/// All problems with all methods. The figures, apart from time, depend on sets, runs and seed only.
std::vector<TableRow> paper_table(const PaperTableOptions& options);

}  // namespace cremed
