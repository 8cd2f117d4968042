// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "estimator/registration.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Detections;
using simulation::Noise;
using simulation::Random;
using simulation::uniform;

constexpr double kDt = 0.2;

/// A simulated problem of the paper, and what may be added to it.
struct Scenario {
  RegistrationOptions options = simulation::paper_options();
  Noise noise;
  double min_range_m = 2.5;
  double max_range_m = 37.5;
  double half_spread_rad = radians(55.0);
  double half_view_rad = radians(40.0);
  double max_yaw_rad = radians(15.0);
  double clutter = 0.0;  ///< Share of each scan that is not in the other one.
  double movers = 0.0;   ///< Share of the landmarks that move on their own.
};

/// Gross failures (wrong basin, no convergence) are counted and left out of the other figures.
struct Statistics {
  std::size_t runs = 0;
  double gross = 0.0;  ///< Share of them.
  double rmse_m = 0.0;
  double rmse_rad = 0.0;
  double anees = 0.0;
  double covered = 0.0;  ///< Share of errors in the 95 % region.
  double bias_x = 0.0;   ///< Mean error over its standard deviation.
  double bias_yaw = 0.0;
};

/// Chance throws a credible error as far as this once in 10^8.
constexpr double kGross = 40.0;

void keep_visible(Detections& detections, double half_view_rad) {
  std::erase_if(detections, [&](const Detection& detection) {
    return std::abs(detection.azimuth_rad) > half_view_rad || detection.range_m <= 0.0;
  });
}

void add_clutter(Detections& detections, const Scenario& scenario, Random& random) {
  const double ratio = scenario.clutter / (1.0 - scenario.clutter);
  const auto count = std::lround(ratio * static_cast<double>(detections.size()));
  for (const Eigen::Vector2d& point :
       simulation::scatter(random, static_cast<std::size_t>(count), scenario.min_range_m,
                           scenario.max_range_m, scenario.half_view_rad, 0.0)) {
    Detection detection = simulation::observe(point, Eigen::Vector3d::Zero(), {}, scenario.noise);
    detection.doppler_mps = uniform(random, -30.0, 30.0);
    detections.push_back(detection);
  }
}

/// Lets the first landmarks drive away, which shows in position and Doppler.
void move_landmarks(Detections& current, double share, Random& random) {
  const auto count = static_cast<std::size_t>(share * static_cast<double>(current.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const double speed_mps = uniform(random, 2.0, 20.0);
    current[i].doppler_mps += speed_mps;
    current[i].range_m += speed_mps * kDt;
  }
}

struct Run {
  Eigen::Vector3d error;
  RegistrationResult result;
};

Run run(const Scenario& scenario, Random& random) {
  const bool is_car = scenario.options.degrees_of_freedom == 2;
  const simulation::Points points = simulation::scatter(
      random, 20, scenario.min_range_m, scenario.max_range_m, scenario.half_spread_rad, 0.0);
  const Eigen::Vector3d motion{uniform(random, -0.25, 0.25),
                               is_car ? 0.0 : uniform(random, -0.25, 0.25),
                               uniform(random, -scenario.max_yaw_rad, scenario.max_yaw_rad)};
  Detections previous =
      simulation::observe_all(points, Eigen::Vector3d::Zero(), kDt, {}, scenario.noise);
  Detections current = simulation::observe_all(points, motion, kDt, {}, scenario.noise);
  move_landmarks(current, scenario.movers, random);
  for (Detections* detections : {&previous, &current}) {
    simulation::perturb(*detections, random);
    keep_visible(*detections, scenario.half_view_rad);
    add_clutter(*detections, scenario, random);
  }
  Registration registration(scenario.options, {});
  registration.set_previous(simulation::targets(previous, {}));
  const RegistrationResult result = registration.solve(simulation::targets(current, {}), kDt);
  return {result.motion - motion, result};
}

Statistics evaluate(const Scenario& scenario, std::size_t runs) {
  Random random(20220411);
  const int degrees_of_freedom = scenario.options.degrees_of_freedom;
  const double limit = degrees_of_freedom == 2 ? 5.991 : 7.815;
  Statistics sum;
  for (std::size_t i = 0; i < runs; ++i) {
    const auto [error, result] = run(scenario, random);
    const double nees = numeric::normalised_error(error, result.covariance, degrees_of_freedom);
    if (result.status != RegistrationStatus::converged || !(nees < kGross)) {
      sum.gross += 1.0;
      continue;
    }
    ++sum.runs;
    sum.rmse_m += error.head<2>().squaredNorm();
    sum.rmse_rad += error.z() * error.z();
    sum.anees += nees / degrees_of_freedom;
    sum.covered += nees <= limit ? 1.0 : 0.0;
    sum.bias_x += error.x() / std::sqrt(result.covariance(0, 0));
    sum.bias_yaw += error.z() / std::sqrt(result.covariance(2, 2));
  }
  const auto n = static_cast<double>(sum.runs);
  return {sum.runs,
          sum.gross / static_cast<double>(runs),
          std::sqrt(sum.rmse_m / n),
          std::sqrt(sum.rmse_rad / n),
          sum.anees / n,
          sum.covered / n,
          sum.bias_x / n,
          sum.bias_yaw / n};
}

Scenario without_doppler() {
  Scenario scenario;
  scenario.options.doppler.enabled = false;
  return scenario;
}

/// Point set registration: all around, three states, no outlier model, one stage.
Scenario point_set() {
  Scenario scenario = without_doppler();
  scenario.options.degrees_of_freedom = 3;
  scenario.options.start_scale = 1.0;
  scenario.options.outlier_ray.weight = 0.0;
  scenario.noise = {0.2, radians(3.0), 0.3};
  scenario.min_range_m = 5.0;
  scenario.max_range_m = 15.0;
  scenario.half_spread_rad = radians(180.0);
  scenario.half_view_rad = radians(360.0);
  return scenario;
}

TEST_CASE(
    "the paper's simulated problems come out as published, and their covariance is credible") {
  // What the reference implementation does on 400 pairs of each.
  struct Row {
    std::string what;
    Scenario scenario;
    double rmse_m, rmse_deg, anees;
  };
  const std::vector<Row> rows = {{"Sim with Doppler", Scenario(), 0.01686, 0.36705, 1.049},
                                 {"Sim", without_doppler(), 0.05418, 0.36789, 1.046},
                                 {"PSR", point_set(), 0.12298, 0.93831, 1.055}};
  for (const Row& row : rows) {
    const Statistics actual = evaluate(row.scenario, 2000);
    const int states = row.scenario.options.degrees_of_freedom;
    CAPTURE(row.what, actual.rmse_m, actual.rmse_rad, actual.anees, actual.covered, actual.gross);
    CHECK(actual.gross < 0.005);
    // Four standard deviations of both figures, ours of 2000 runs and the reference's of 400.
    const double rmse_bound =
        4.0 * std::hypot(numeric::rmse_deviation(actual.runs), numeric::rmse_deviation(400));
    CHECK(actual.rmse_m == Approx(row.rmse_m).epsilon(rmse_bound));
    CHECK(actual.rmse_rad == Approx(radians(row.rmse_deg)).epsilon(rmse_bound));
    const double anees_bound = 4.0 * numeric::anees_deviation(actual.runs, states);
    CHECK(actual.anees > 1.0 - anees_bound);
    CHECK(actual.anees < row.anees + anees_bound);
    CHECK(std::abs(actual.covered - 0.95) < 0.01 + 4.0 * numeric::share_deviation(0.95, 2000));
    const double bias_bound = 4.0 / std::sqrt(static_cast<double>(actual.runs));
    CHECK(std::abs(actual.bias_x) < bias_bound);
    CHECK(std::abs(actual.bias_yaw) < bias_bound);
  }
}

TEST_CASE(
    "half a scan of clutter, or three movers in ten, cost little; without their model a lot") {
  Scenario clean;
  clean.max_yaw_rad = radians(3.0);
  clean.options.outlier_ray.weight = 0.5;
  Scenario clutter = clean;
  clutter.clutter = 0.5;
  Scenario movers = clean;
  movers.movers = 0.3;
  const Statistics reference = evaluate(clean, 1000);
  for (const Scenario& scenario : {clutter, movers}) {
    const Statistics actual = evaluate(scenario, 1000);
    CAPTURE(scenario.clutter, scenario.movers, actual.anees, actual.covered);
    CHECK(actual.gross < 0.01);
    CHECK(actual.rmse_m < 1.5 * reference.rmse_m);
    CHECK(actual.rmse_rad < 1.5 * reference.rmse_rad);
    CHECK(actual.covered > 0.85);
  }
  clutter.options.outlier_ray.weight = 0.0;
  CHECK(evaluate(clutter, 200).gross > 0.5);
  movers.options.doppler.moving_weight = 0.0;
  CHECK(evaluate(movers, 200).gross > 0.5);
}

TEST_CASE("the scaled start finds motions that a single stage misses") {
  const auto share_found = [](double start_scale) {
    Scenario scenario = without_doppler();
    scenario.options.start_scale = start_scale;
    scenario.max_yaw_rad = radians(20.0);
    Random random(7);
    int found = 0;
    for (int i = 0; i < 500; ++i) {
      const auto [error, result] = run(scenario, random);
      found += numeric::normalised_error(error, result.covariance, 2) < 20.0 ? 1 : 0;
    }
    return found / 500.0;
  };
  CHECK(share_found(6.0) > 0.97);
  CHECK(share_found(1.0) < 0.85);
}

}  // namespace
}  // namespace cremed
