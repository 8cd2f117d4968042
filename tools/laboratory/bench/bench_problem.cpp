// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/bench/bench_problem.hpp"

#include "tools/laboratory/pairs/profile.hpp"
#include "tools/laboratory/table/simulated_pairs.hpp"

namespace cremed {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kSets = 50;
constexpr std::size_t kRuns = 2;
constexpr std::size_t kPairsOfSize = 10;
constexpr double kIntervalS = 0.2;

/// The rectangle of targets, about `x_m` ahead of the vehicle.
struct Area {
  double x_m;
  double half_length_m;
  double half_width_m;
};

/// Static targets seen by a radar at the vehicle's origin that drives straight ahead.
RegistrationPair random_pair(std::size_t targets, const Area& area, const DetectionNoise& noise,
                             Random& random) {
  RegistrationPair pair;
  pair.dt_s = kIntervalS;
  pair.truth.x_m = random.uniform(-0.25, 0.25);
  const Eigen::Vector2d moved_m(pair.truth.x_m, 0.0);
  for (std::size_t i = 0; i < targets; ++i) {
    const double ahead_m = area.x_m + area.half_length_m * random.uniform(-1.0, 1.0);
    const Eigen::Vector2d point_m(ahead_m, area.half_width_m * random.uniform(-1.0, 1.0));
    pair.previous.push_back(observe(point_m, moved_m / kIntervalS, noise, random));
    pair.current.push_back(observe(point_m - moved_m, moved_m / kIntervalS, noise, random));
  }
  return pair;
}

}  // namespace

std::vector<BenchProblem> simulated_problems(Likelihood likelihood) {
  std::vector<BenchProblem> problems;
  for (const bool doppler : {false, true}) {
    for (const SimulatedProblem problem : kSimulatedProblems) {
      const SimulatedProblemSettings& of = settings(problem);
      if (doppler && of.degrees_of_freedom == 3) {
        continue;
      }
      problems.push_back({std::string(of.name).append(doppler ? "-D" : ""),
                          *profile(of.profile, doppler, likelihood),
                          simulated_pairs(problem, kSeed, kSets, kRuns)});
    }
  }
  return problems;
}

BenchProblem problem_of_size(std::size_t targets, Likelihood likelihood) {
  Random random(kSeed, 0);
  BenchProblem problem{std::to_string(targets), *profile("sim", true, likelihood), {}};
  for (std::size_t k = 0; k < kPairsOfSize; ++k) {
    problem.pairs.push_back(random_pair(targets, {30.0, 28.0, 25.0}, {0.13, 0.0157, 0.3}, random));
  }
  return problem;
}

BenchProblem ambiguous_problem(Likelihood likelihood) {
  Random random(kSeed, 0);
  BenchProblem problem{"worst", *profile("nuscenes", true, likelihood), {}};
  problem.options.degrees_of_freedom = 3;
  for (std::size_t k = 0; k < kPairsOfSize; ++k) {
    problem.pairs.push_back(
        random_pair(kMaxDetections, {20.0, 0.5, 0.5}, {0.5, 0.025, 0.3}, random));
  }
  return problem;
}

}  // namespace cremed
