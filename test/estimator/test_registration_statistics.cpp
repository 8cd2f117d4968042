// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "test/estimator/numeric.hpp"
#include "test/estimator/scenario.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::point_set;
using simulation::Random;
using simulation::Scenario;
using simulation::without_doppler;

/// Gross failures (wrong basin, no convergence) are counted and excluded from the other figures.
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

/// A credible error exceeds this by chance once in 10^8.
constexpr double kGross = 40.0;

Statistics evaluate(const Scenario& scenario, std::size_t runs) {
  Random random(20220411);
  const int degrees_of_freedom = scenario.options.degrees_of_freedom;
  const double limit = degrees_of_freedom == 2 ? 5.991 : 7.815;
  Statistics sum;
  for (std::size_t i = 0; i < runs; ++i) {
    const auto [error, result] = simulation::run(scenario, random);
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

TEST_CASE(
    "the paper's simulated problems come out as published, and their covariance is credible") {
  // The reference implementation's figures on 400 pairs of each.
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
  movers.options.doppler.moving_weight = 0.0;
  CHECK(evaluate(movers, 200).gross > 0.5);
  // With one-to-one assignment most of the clutter has no partner; in a mixture it always has one.
  const Statistics with_ray = evaluate(clutter, 1000);
  clutter.options.outlier_ray.weight = 0.0;
  const Statistics without_ray = evaluate(clutter, 1000);
  CAPTURE(with_ray.anees, without_ray.anees);
  CHECK(without_ray.gross < 0.02);
  CHECK(without_ray.anees > with_ray.anees + 0.2);
  clutter.options.likelihood = Likelihood::max_sum_mixture;
  CHECK(evaluate(clutter, 200).gross > 0.5);
}

TEST_CASE("one-to-one assignments are credible on all of the paper's problems, clusters or not") {
  struct Row {
    std::string what;
    Scenario scenario;
    std::size_t clusters;
  };
  const std::vector<Row> rows = {{"PSR", point_set(), 0},       {"PSR-C", point_set(), 8},
                                 {"Sim", without_doppler(), 0}, {"Sim-C", without_doppler(), 8},
                                 {"Sim-D", Scenario(), 0},      {"Sim-C-D", Scenario(), 8}};
  // 99.9 %; with this many degrees of freedom chi-square is normal.
  constexpr double kQuantile = 3.29;
  for (const Row& row : rows) {
    Scenario scenario = row.scenario;
    scenario.clusters = row.clusters;
    const Statistics exclusive = evaluate(scenario, 2500);
    scenario.options.likelihood = Likelihood::max_sum_mixture;
    const Statistics gauss_newton = evaluate(scenario, 2500);
    const double width =
        kQuantile * numeric::anees_deviation(exclusive.runs, scenario.options.degrees_of_freedom);
    CAPTURE(row.what, exclusive.anees, gauss_newton.anees, width);
    CHECK(exclusive.gross < 0.002);
    CHECK(std::abs(exclusive.anees - 1.0) < width);
    CHECK(std::abs(exclusive.covered - 0.95) < 4.0 * numeric::share_deviation(0.95, 2500));
    CHECK(exclusive.rmse_m < 1.01 * gauss_newton.rmse_m);
    CHECK(exclusive.rmse_rad < gauss_newton.rmse_rad);
    if (row.clusters > 0) {
      CHECK(gauss_newton.anees > 1.0 + width);
    }
  }
}

}  // namespace
}  // namespace cremed
