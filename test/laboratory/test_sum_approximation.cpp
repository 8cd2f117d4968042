// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "test/estimator/numeric.hpp"
#include "test/laboratory/scan_pair.hpp"
#include "tools/laboratory/pairs/sum_approximation.hpp"

using namespace cremed;

namespace {

RegistrationContext context_of(int degrees_of_freedom, bool doppler) {
  RegistrationContext context;
  context.options.degrees_of_freedom = degrees_of_freedom;
  context.options.doppler.enabled = doppler;
  context.options.start_scale = 1.0;
  context.dt_s = 0.1;
  return context;
}

}  // namespace

TEST_CASE("One target on one target costs as its normal density says") {
  const test::ScanPair scans = [] {
    test::ScanPair pair;
    pair.previous.add(test::seen_from(Pose2{}, 10.0, 0.0, 0.1), Pose2{});
    pair.current.add(test::seen_from(Pose2{}, 10.0, 0.0, 0.1), Pose2{});
    return pair;
  }();
  // C = 2 diag(0.1^2, (10 * 0.01)^2); e = (0.2, 0, 0).
  const double determinant = 0.02 * 0.02;
  const double density =
      std::exp(-0.5 * 0.04 / 0.02) / (2.0 * std::numbers::pi * std::sqrt(determinant));
  const Eigen::Vector3d motion(0.2, 0.0, 0.0);
  CHECK(sum_approximation_cost(scans.previous, scans.current, context_of(3, false), motion) ==
        Approx(-std::log(density)));
  // Predicted change of range -0.2 m, measured 0 m; 0.1 m/s for 0.1 s, 5 ms of no Doppler.
  const double doppler = std::exp(-0.5 * 0.04 / 1e-4) / std::sqrt(2.0 * std::numbers::pi * 1e-4);
  CHECK(sum_approximation_cost(scans.previous, scans.current, context_of(3, true), motion) ==
        Approx(-std::log(density) - std::log(doppler)));
}

TEST_CASE("The summing approximation finds a small true motion when there is no noise") {
  const auto degrees_of_freedom = GENERATE(2, 3);
  const auto doppler = GENERATE(false, true);
  const auto start_scale = GENERATE(1.0, 5.0);
  CAPTURE(degrees_of_freedom, doppler, start_scale);
  const Pose2 truth{0.06, degrees_of_freedom == 3 ? -0.05 : 0.0, 0.008};
  const test::ScanPair scans = test::scan_pair(truth, 0.1);
  RegistrationContext context = context_of(degrees_of_freedom, doppler);
  context.options.start_scale = start_scale;
  const RegistrationResult result =
      register_sum_approximation(scans.previous, scans.current, context);
  REQUIRE(result.status == RegistrationStatus::converged);
  // The covariance depends on yaw, which moves the minimum slightly off the truth.
  CHECK(result.motion.x() == Approx(truth.x_m).margin(2e-3));
  CHECK(result.motion.y() == Approx(truth.y_m).margin(2e-3));
  CHECK(result.motion.z() == Approx(truth.yaw_rad).margin(2e-4));
  Eigen::Vector3d gradient =
      numeric::central_differences(result.motion, 1e-6, [&](const Eigen::Vector3d& at) {
        return sum_approximation_cost(scans.previous, scans.current, context, at);
      });
  gradient.y() = degrees_of_freedom == 3 ? gradient.y() : 0.0;
  CHECK(gradient.norm() < 1e-2);
  CHECK(result.covariance(0, 0) > 0.0);
  CHECK((result.covariance(1, 1) == 0.0) == (degrees_of_freedom == 2));
  CHECK(numeric::eigenvalues(result.covariance)(0) >= -1e-15);
}

TEST_CASE("A Hessian that is not positive definite is degenerate, not a covariance") {
  TargetSet one;
  one.add(test::seen_from(Pose2{}, 10.0, 0.0, 0.1), Pose2{});
  // A single target: rotation about it costs nothing, or gains by the rotation of its covariance.
  const RegistrationResult result = register_sum_approximation(one, one, context_of(3, false));
  CHECK(result.status == RegistrationStatus::degenerate);
}
