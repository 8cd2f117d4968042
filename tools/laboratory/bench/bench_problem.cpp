// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/bench/bench_problem.hpp"

#include <cmath>
#include <random>

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

struct Sensor {
  double range_std_m;
  double azimuth_std_rad;
  double doppler_std_mps;
};

struct Point {
  double x_m;
  double y_m;
};

/// A static target seen by a radar at the vehicle's origin that drives straight ahead.
Detection see(const Point& point, double speed_mps, const Sensor& sensor, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Detection detection;
  detection.range_std_m = sensor.range_std_m;
  detection.azimuth_std_rad = sensor.azimuth_std_rad;
  detection.doppler_std_mps = sensor.doppler_std_mps;
  const double azimuth_rad = std::atan2(point.y_m, point.x_m);
  detection.range_m = std::hypot(point.x_m, point.y_m) + sensor.range_std_m * normal(random);
  detection.azimuth_rad = azimuth_rad + sensor.azimuth_std_rad * normal(random);
  detection.doppler_mps =
      -speed_mps * std::cos(azimuth_rad) + sensor.doppler_std_mps * normal(random);
  detection.validity = Validity::usable;
  return detection;
}

RegistrationPair random_pair(std::size_t targets, const Area& area, const Sensor& sensor,
                             std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  RegistrationPair pair;
  pair.dt_s = kIntervalS;
  pair.truth.x_m = 0.25 * unit(random);
  const double speed_mps = pair.truth.x_m / kIntervalS;
  for (std::size_t i = 0; i < targets; ++i) {
    const Point point{area.x_m + area.half_length_m * unit(random),
                      area.half_width_m * unit(random)};
    pair.previous.push_back(see(point, speed_mps, sensor, random));
    pair.current.push_back(see({point.x_m - pair.truth.x_m, point.y_m}, speed_mps, sensor, random));
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
  std::mt19937_64 random(kSeed);
  BenchProblem problem{std::to_string(targets), *profile("sim", true, likelihood), {}};
  for (std::size_t k = 0; k < kPairsOfSize; ++k) {
    problem.pairs.push_back(random_pair(targets, {30.0, 28.0, 25.0}, {0.13, 0.0157, 0.3}, random));
  }
  return problem;
}

BenchProblem ambiguous_problem(Likelihood likelihood) {
  std::mt19937_64 random(kSeed);
  BenchProblem problem{"worst", *profile("nuscenes", true, likelihood), {}};
  problem.options.degrees_of_freedom = 3;
  for (std::size_t k = 0; k < kPairsOfSize; ++k) {
    problem.pairs.push_back(
        random_pair(kMaxDetections, {20.0, 0.5, 0.5}, {0.5, 0.025, 0.3}, random));
  }
  return problem;
}

}  // namespace cremed
