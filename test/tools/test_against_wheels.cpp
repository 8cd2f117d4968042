// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "test/tools/circle.hpp"
#include "tools/eval/chi_square.hpp"
#include "tools/eval/drive/against_wheels.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr std::size_t kSteps = 4000;

Eigen::Matrix3d skewed_covariance() {
  Eigen::Matrix3d matrix = Eigen::Vector3d(0.005, 0.004, 0.001).cwiseAbs2().asDiagonal();
  matrix(1, 2) = matrix(2, 1) = 2e-6;
  return matrix;
}

void check_is_one(double nees) {
  const Interval interval = anees_interval(kSteps, 1, 0.999);
  CHECK(nees > interval.low);
  CHECK(nees < interval.high);
}

}  // namespace

TEST_CASE("True covariances have NEES 1 against true wheels, whatever the noise of truth") {
  const double truth_m = GENERATE(0.0, 0.01);
  CAPTURE(truth_m);
  const Circle circle;
  Random random(11, 0);
  const Eigen::Vector3d noise{truth_m, truth_m, 0.1 * truth_m};
  const auto truth = circle.truth(kStepUs, kSteps, noise, random);
  const auto wheels = read_wheels(circle.wheels_csv(400.0));
  const auto estimates = circle.estimates(kStepUs, kSteps, skewed_covariance(), random);
  const MotionsAgainstWheels result = against_wheels(estimates, truth, wheels);
  REQUIRE(result.x.count == kSteps);
  check_is_one(result.x.nees);
  check_is_one(result.yaw.nees);
  CHECK(result.x.nees_estimate == result.x.nees);
  CHECK(result.x.rms_estimate_per_s == Approx(0.05).epsilon(0.05));
  CHECK(result.yaw.rms_estimate_per_s == Approx(0.01).epsilon(0.05));
  // Two poses of truth have an error each; the error of direction hardly moves x.
  CHECK(result.x.nees_truth ==
        Approx(2.0 * std::pow(truth_m / 0.005, 2)).epsilon(0.06).margin(1e-6));
  CHECK(result.yaw.nees_truth ==
        Approx(2.0 * std::pow(0.1 * truth_m / 0.001, 2)).epsilon(0.06).margin(1e-6));
  CHECK(result.x.rms_truth_per_s ==
        Approx(std::sqrt(2.0) * 10.0 * truth_m).epsilon(0.05).margin(1e-5));
  // Independent errors: their product's mean is 0 within 4 of its standard deviation.
  const double cross_std = 2.0 * std::sqrt(result.x.nees_truth / static_cast<double>(kSteps));
  CHECK(std::abs(result.x.nees_cross) < 4.0 * cross_std + 1e-3);
}

TEST_CASE("The split adds up to NEES of the axis against truth") {
  const Circle circle;
  Random random(12, 0);
  const auto truth = circle.truth(kStepUs, 200, {0.01, 0.01, 0.002}, random);
  const auto wheels = read_wheels(circle.wheels_csv(20.0, {0.03, 0.002}));
  const auto estimates = circle.estimates(kStepUs, 200, skewed_covariance(), random);
  const MotionsAgainstWheels result = against_wheels(estimates, truth, wheels);
  double nees_x = 0.0;
  double nees_yaw = 0.0;
  double squares_m2ps2 = 0.0;
  for (const RecordedEstimate& estimate : estimates) {
    const Eigen::Vector3d error =
        estimate.motion - *truth.motion(estimate.start_us, estimate.end_us);
    nees_x += error.x() * error.x() / skewed_covariance()(0, 0) / 200.0;
    nees_yaw += error.z() * error.z() / skewed_covariance()(2, 2) / 200.0;
    squares_m2ps2 += 100.0 * error.x() * error.x() / 200.0;
  }
  CHECK(result.x.nees_against_truth() == Approx(nees_x));
  CHECK(result.yaw.nees_against_truth() == Approx(nees_yaw));
  CHECK(result.x.rms_both_per_s == Approx(std::sqrt(squares_m2ps2)));
  CHECK(std::abs(result.x.nees_cross) > 0.05);
}

TEST_CASE("What the wheels may be off widens the covariance, but not the split") {
  const Circle circle;
  Random random(13, 0);
  const auto truth = circle.truth(kStepUs, 100, Eigen::Vector3d::Zero(), random);
  const WheelStd off{0.05, 0.01};
  const auto exact = circle.estimates(kStepUs, 100, 1e-12 * Eigen::Matrix3d::Identity(), random);
  auto estimates = exact;
  for (RecordedEstimate& estimate : estimates) estimate.covariance = skewed_covariance();
  const auto result =
      against_wheels(estimates, truth, read_wheels(circle.wheels_csv(10.0, off), off));
  // Errors of 5 mm and 1 mrad, where estimate and wheels have 5 mm and 1 mrad each.
  CHECK(result.x.nees == Approx(0.5).epsilon(0.01));
  CHECK(result.yaw.nees == Approx(0.5).epsilon(0.01));
  CHECK(result.x.nees_estimate == Approx(1.0).epsilon(0.01));
  CHECK(result.x.nees_cross == Approx(-2.0).epsilon(0.01));
  CHECK(result.x.nees_against_truth() == Approx(0.0).margin(1e-3));
}

TEST_CASE("Only motions that truth and wheels cover are compared, the others have no figures") {
  const Circle circle;
  Random random(14, 0);
  const auto truth = circle.truth(kStepUs, 50, Eigen::Vector3d::Zero(), random);
  const auto wheels = read_wheels(circle.wheels_csv(3.0));
  const auto estimates = circle.estimates(kStepUs, 100, skewed_covariance(), random);
  CHECK(against_wheels(estimates, truth, wheels).x.count == 30);
  CHECK(std::isnan(against_wheels(std::vector<RecordedEstimate>{}, truth, wheels).x.nees));
}

TEST_CASE("Truth against the wheels is the noise of truth's relative poses") {
  const Circle circle;
  Random random(15, 0);
  const auto truth = circle.truth(10'000, 40'000, {0.01, 0.004, 0.0003}, random);
  const auto wheels = read_wheels(circle.wheels_csv(400.0));
  const auto row = truth_against_wheels(truth, wheels, kStepUs);
  CHECK(row.interval_s == Approx(0.1));
  CHECK(row.count == 40'000 - 9);
  CHECK(row.rms_x_m == Approx(std::sqrt(2.0) * 0.01).epsilon(0.03));
  // Between 0.8 m apart the direction of the first pose adds 0.24 mm.
  CHECK(row.rms_y_m == Approx(std::sqrt(2.0) * 0.004).epsilon(0.03));
  CHECK(row.rms_yaw_rad == Approx(std::sqrt(2.0) * 0.0003).epsilon(0.03));
}

TEST_CASE("The direction in which the vehicle rolls is no noise of y") {
  const Circle circle;
  Random random(16, 0);
  const auto exact = circle.truth(10'000, 4000, Eigen::Vector3d::Zero(), random);
  std::vector<Pose2> turned = exact.poses();
  for (Pose2& pose : turned) pose.yaw_rad += 0.01;
  const TrueTrajectory truth(exact.utime_us(), turned);
  const auto wheels = read_wheels(circle.wheels_csv(40.0));
  CHECK(truth_against_wheels(truth, wheels, kStepUs).rms_y_m < 1e-4);
  CHECK(truth_against_wheels(truth, wheels, 50'000'000).count == 0);
  CHECK(std::isnan(truth_against_wheels(truth, wheels, 50'000'000).rms_x_m));
}
