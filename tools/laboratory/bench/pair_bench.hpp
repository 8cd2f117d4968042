// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "tools/laboratory/bench/bench_problem.hpp"

namespace cremed {

/// Registers a benchmark "group/name" of a problem; an iteration is one pair, in processor time.
/// Counters over all pairs: p50_us, p99_us, max_us, least_us (mean of each pair's least),
/// evaluations (of mixture components), floor_us (as many bare evaluations, see floor.hpp), ratio
/// (least_us over floor_us), targets, ns_per_target2.
void register_pair_bench(const std::string& group, BenchProblem problem);

}  // namespace cremed
