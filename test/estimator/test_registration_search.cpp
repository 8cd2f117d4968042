// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "test/estimator/numeric.hpp"
#include "test/estimator/scenario.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Random;
using simulation::Scenario;
using simulation::without_doppler;

struct Shares {
  double found = 0.0;            ///< Share of all runs.
  double searched_again = 0.0;   ///< The first search had a poor fit.
  double confident_wrong = 0.0;  ///< Converged to a wrong motion.
};

Shares search(Likelihood likelihood, double start_scale, double max_yaw_rad) {
  constexpr int kRuns = 500;
  Scenario scenario = without_doppler();
  scenario.options.likelihood = likelihood;
  scenario.options.start_scale = start_scale;
  scenario.max_yaw_rad = max_yaw_rad;
  Random random(7);
  Shares shares;
  for (int i = 0; i < kRuns; ++i) {
    const auto [error, result] = simulation::run(scenario, random);
    const bool is_found = result.status == RegistrationStatus::converged &&
                          numeric::normalised_error(error, result.covariance, 2) < 20.0;
    shares.found += is_found ? 1.0 / kRuns : 0.0;
    shares.searched_again += result.starts > 1 ? 1.0 / kRuns : 0.0;
    const bool is_wrong = result.status == RegistrationStatus::converged && !is_found;
    shares.confident_wrong += is_wrong ? 1.0 / kRuns : 0.0;
  }
  return shares;
}

TEST_CASE("the scaled start finds motions that a single stage misses") {
  const auto share_found = [](double start_scale) {
    return search(Likelihood::max_sum_mixture, start_scale, radians(20.0)).found;
  };
  CHECK(share_found(6.0) > 0.97);
  CHECK(share_found(1.0) < 0.85);
}

TEST_CASE("a search that ends in a local minimum is noticed and made again") {
  struct Row {
    double start_scale;
    double max_yaw_rad;
  };
  // A single search fails in more than 0.2 of these runs.
  for (const Row& row : {Row{6.0, radians(30.0)}, Row{1.0, radians(15.0)}}) {
    CAPTURE(row.start_scale);
    const Shares once = search(Likelihood::max_sum_mixture, row.start_scale, row.max_yaw_rad);
    CHECK(once.confident_wrong > 0.2);
    const Shares again = search(Likelihood::exclusive, row.start_scale, row.max_yaw_rad);
    CHECK(again.searched_again > 0.2);
    CHECK(again.found > 0.99);
    CHECK(again.confident_wrong == 0.0);
  }
  // The search is repeated only if needed.
  CHECK(search(Likelihood::exclusive, 6.0, radians(10.0)).searched_again < 0.01);
}

}  // namespace
}  // namespace cremed
