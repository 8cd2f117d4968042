// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/registration/registration.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/scenario.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Detections;
using simulation::kStill;
using simulation::paper_options;
using simulation::Points;
using simulation::Random;
using simulation::see;
using simulation::solve;
using simulation::uniform;

/// Two scans that have no target in common, the nearest of them 135 m apart.
struct Strangers {
  explicit Strangers(Random& random)
      : near(simulation::scatter(random, 20, 5.0, 15.0, radians(40.0), 0.0)),
        far(simulation::scatter(random, 20, 150.0, 200.0, radians(40.0), 0.0)) {}

  Points near;
  Points far;
};

TEST_CASE("with max_sum_mixture Doppler gives the speed without a common place") {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Strangers scans(random);
    const Eigen::Vector3d motion(uniform(random, -1.0, 1.0), 0.0, radians(4.0));
    const RegistrationResult result = solve(paper_options(2, true, Likelihood::max_sum_mixture),
                                            see(scans.near, kStill), see(scans.far, motion));
    const double sigma_m = std::sqrt(result.covariance(0, 0));
    CHECK(sigma_m < 0.05);
    CHECK(std::abs(result.motion.x() - motion.x()) < sigma_m);
  }
}

TEST_CASE("without a common place there is no motion, even with Doppler") {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const Strangers scans(random);
    const Eigen::Vector3d motion(uniform(random, -1.0, 1.0), 0.0, radians(4.0));
    for (const bool has_doppler : {false, true}) {
      const RegistrationResult result =
          solve(paper_options(2, has_doppler), see(scans.near, kStill), see(scans.far, motion));
      CAPTURE(i, has_doppler);
      // Without Doppler the first stage may jump to the other place.
      const bool is_honest = result.status == RegistrationStatus::degenerate ||
                             (!has_doppler && result.status == RegistrationStatus::ambiguous);
      CHECK(is_honest);
    }
  }
}

TEST_CASE("the first stage widens Doppler by both scales") {
  Random random(11);
  const Strangers scans(random);
  const Eigen::Vector3d motion(1.4, 0.0, 0.0);
  const auto is_found = [&](double start_doppler_scale) {
    RegistrationOptions options = paper_options(2, true, Likelihood::max_sum_mixture);
    options.start_doppler_scale = start_doppler_scale;
    const RegistrationResult result =
        solve(options, see(scans.near, kStill), see(scans.far, motion));
    return std::abs(result.motion.x() - motion.x()) < 0.1;
  };
  CHECK_FALSE(is_found(0.2));
  CHECK(is_found(5.0));
}

TEST_CASE("scans of different places do not give a confident turn") {
  struct Row {
    int degrees_of_freedom;
    bool has_doppler;
    double weight;
    int max_wrong;
  };
  constexpr int kRuns = 300;
  // By chance enough targets match in a few percent, most often without Doppler.
  const std::vector<Row> rows = {{2, true, 0.5, 3},
                                 {2, true, 0.2, 12},
                                 {2, false, 0.2, 15},
                                 {3, true, 0.2, 12},
                                 {3, false, 0.5, 15}};
  for (const Row& row : rows) {
    Random random(4);
    int converged = 0;
    int confident_and_wrong = 0;
    for (int i = 0; i < kRuns; ++i) {
      const Points here = simulation::scatter(random, 20, 2.5, 37.5, radians(40.0), 0.0);
      const Points there = simulation::scatter(random, 20, 2.5, 37.5, radians(40.0), 0.0);
      const Eigen::Vector3d motion(0.2, 0.0, radians(uniform(random, -3.0, 3.0)));
      RegistrationOptions options = paper_options(row.degrees_of_freedom, row.has_doppler);
      options.outlier_ray.weight = row.weight;
      const RegistrationResult result = solve(options, see(here, kStill), see(there, motion));
      const double sigma_rad = std::sqrt(result.covariance(2, 2));
      const bool is_wrong = std::abs(result.motion.z() - motion.z()) > 4.0 * sigma_rad;
      converged += result.status == RegistrationStatus::converged ? 1 : 0;
      confident_and_wrong += result.status == RegistrationStatus::converged && is_wrong ? 1 : 0;
    }
    CAPTURE(row.degrees_of_freedom, row.has_doppler, row.weight, converged);
    CHECK(confident_and_wrong <= row.max_wrong);
  }
}

}  // namespace
}  // namespace cremed
