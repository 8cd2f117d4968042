// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/bench/component_bench.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>

#include <benchmark/benchmark.h>

#include "cremed/estimator/cost/mixture.hpp"
#include "tools/laboratory/bench/bench_problem.hpp"
#include "tools/laboratory/bench/floor.hpp"
#include "tools/laboratory/pairs/pairs_evaluation.hpp"

namespace cremed {
namespace {

constexpr std::size_t kPoints = 64;

void run(benchmark::State& state) {
  const auto size = static_cast<std::size_t>(state.range(0));
  const BenchProblem problem = problem_of_size(size, Likelihood::max_sum_mixture);
  const RegistrationPair& pair = problem.pairs.front();
  const OutlierRay ray(problem.options.outlier_ray, pair.vehicle_from_radar);
  const auto mixture = std::make_unique<Mixture>();
  mixture->assign(to_targets(pair.previous, pair.vehicle_from_radar), ray);
  const TargetSet current = to_targets(pair.current, pair.vehicle_from_radar);
  double least_ns = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < kPoints; ++i) {
      const Target& target = current[i % current.size()];
      benchmark::DoNotOptimize(
          mixture->evaluate({target.x_m, target.y_m}, target.covariance_m2).cost);
    }
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - begin;
    least_ns = std::min(least_ns, taken.count());
  }
  state.SetComplexityN(static_cast<std::int64_t>(mixture->size()));
  const double ns = least_ns / static_cast<double>(kPoints * mixture->size());
  const double floor = floor_ns(mixture->size());
  state.counters["ns"] = ns;
  state.counters["floor_ns"] = floor;
  state.counters["ratio"] = ns / floor;
}

}  // namespace

void register_component_bench() {
  benchmark::RegisterBenchmark("components", run)
      ->RangeMultiplier(2)
      ->Range(8, 256)
      ->Complexity(benchmark::oN);
}

}  // namespace cremed
