// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/bench/pair_bench.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "tools/laboratory/bench/floor.hpp"
#include "tools/laboratory/pairs/pairs_evaluation.hpp"

namespace cremed {
namespace {

/// Over all pairs, for the least time of each.
constexpr int kMoreRounds = 3;

/// A pair ready to be registered.
struct Case {
  TargetSet previous;
  TargetSet current;
  double dt_s;
  std::shared_ptr<Registration> registration;
  double least_us = std::numeric_limits<double>::infinity();
  std::int64_t evaluations = 0;
};

bool is_same(const Pose2& a, const Pose2& b) {
  return a.x_m == b.x_m && a.y_m == b.y_m && a.yaw_rad == b.yaw_rad;
}

/// Pairs of one mount share a Registration, as the scans of a radar do.
std::vector<Case> prepare(const BenchProblem& problem) {
  std::vector<Case> cases;
  const Pose2* mount = nullptr;
  for (const RegistrationPair& pair : problem.pairs) {
    if (pair.previous.empty() || pair.current.empty()) {
      continue;
    }
    const bool is_known = mount != nullptr && is_same(*mount, pair.vehicle_from_radar);
    auto registration =
        is_known ? cases.back().registration
                 : std::make_shared<Registration>(problem.options, pair.vehicle_from_radar);
    mount = &pair.vehicle_from_radar;
    cases.push_back({to_targets(pair.previous, pair.vehicle_from_radar),
                     to_targets(pair.current, pair.vehicle_from_radar), pair.dt_s,
                     std::move(registration)});
  }
  return cases;
}

double solve_us(Case& pair) {
  const double begin_us = processor_us();
  pair.registration->set_previous(pair.previous);
  const RegistrationResult result = pair.registration->solve(pair.current, pair.dt_s);
  const double taken_us = processor_us() - begin_us;
  pair.evaluations = result.component_evaluations;
  pair.least_us = std::min(pair.least_us, taken_us);
  return taken_us;
}

/// The quantile `share` of the sorted values.
double quantile(const std::vector<double>& sorted, double share) {
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
  return sorted[std::max<std::size_t>(rank, 1) - 1];
}

template <typename Value>
double mean_of(const std::vector<Case>& cases, Value value) {
  double sum = 0.0;
  for (const Case& pair : cases) {
    sum += static_cast<double>(value(pair));
  }
  return sum / static_cast<double>(cases.size());
}

/// The ratio compares least times on both sides, without caches emptied by other programs.
void set_counters(const std::vector<Case>& cases, std::vector<double>& times_us,
                  benchmark::State& state) {
  std::ranges::sort(times_us);
  const double targets = mean_of(cases, [](const Case& c) {
    return 0.5 * static_cast<double>(c.previous.size() + c.current.size());
  });
  const double evaluations = mean_of(cases, [](const Case& c) { return c.evaluations; });
  const double least_us = mean_of(cases, [](const Case& c) { return c.least_us; });
  const double floor_us =
      1e-3 * evaluations * floor_ns(static_cast<std::size_t>(std::lround(targets)));
  state.counters["p50_us"] = quantile(times_us, 0.5);
  state.counters["p99_us"] = quantile(times_us, 0.99);
  state.counters["max_us"] = times_us.back();
  state.counters["least_us"] = least_us;
  state.counters["evaluations"] = evaluations;
  state.counters["floor_us"] = floor_us;
  state.counters["ratio"] = least_us / floor_us;
  state.counters["targets"] = targets;
  state.counters["ns_per_target2"] = 1e3 * least_us / (targets * targets);
}

void run(benchmark::State& state, const BenchProblem& problem) {
  std::vector<Case> cases = prepare(problem);
  if (cases.empty()) {
    state.SkipWithError("no pairs");
    return;
  }
  std::vector<double> times_us;
  std::size_t next = 0;
  for (auto _ : state) {
    times_us.push_back(solve_us(cases[next]));
    state.SetIterationTime(1e-6 * times_us.back());
    next = next + 1 == cases.size() ? 0 : next + 1;
  }
  for (int k = 0; k < kMoreRounds; ++k) {
    std::ranges::for_each(cases, solve_us);
  }
  set_counters(cases, times_us, state);
}

}  // namespace

void register_pair_bench(const std::string& group, BenchProblem problem) {
  const std::string name = group + "/" + problem.name;
  const auto shared = std::make_shared<const BenchProblem>(std::move(problem));
  benchmark::RegisterBenchmark(name.c_str(),
                               [shared](benchmark::State& state) { run(state, *shared); })
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

}  // namespace cremed
