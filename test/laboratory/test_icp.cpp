// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "test/laboratory/scan_pair.hpp"
#include "tools/eval/chi_square.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/laboratory/pairs/icp.hpp"

using namespace cremed;

namespace {

constexpr double kStdM = 0.02;

/// A point with a standard deviation of kStdM in every direction.
void add(TargetSet& targets, const Eigen::Vector2d& point_m) {
  Detection detection;
  detection.range_m = point_m.norm();
  detection.azimuth_rad = std::atan2(point_m.y(), point_m.x());
  detection.range_std_m = kStdM;
  detection.azimuth_std_rad = kStdM / detection.range_m;
  detection.doppler_std_mps = 1.0;
  targets.add(detection, Pose2{});
}

Eigen::Vector2d noise(std::mt19937& generator) {
  std::normal_distribution<double> gaussian(0.0, kStdM);
  const double x_m = gaussian(generator);
  const double y_m = gaussian(generator);
  return {x_m, y_m};
}

}  // namespace

TEST_CASE("ICP finds a small motion when there is no noise") {
  const auto truth =
      GENERATE(Pose2{0.0, 0.0, 0.0}, Pose2{0.3, -0.2, 0.05}, Pose2{-0.4, 0.1, -0.03});
  const test::ScanPair scans = test::scan_pair(truth, 0.1);
  const RegistrationResult result = register_icp(scans.previous, scans.current, {});
  REQUIRE(result.status == RegistrationStatus::converged);
  CHECK(result.motion.x() == Approx(truth.x_m).margin(1e-9));
  CHECK(result.motion.y() == Approx(truth.y_m).margin(1e-9));
  CHECK(result.motion.z() == Approx(truth.yaw_rad).margin(1e-9));
  CHECK(result.iterations >= 1);
  CHECK(result.covariance(0, 0) > 0.0);
}

TEST_CASE("ICP's covariance is credible where the nearest point is the right one") {
  std::mt19937 generator(3);
  Credibility credibility(3);
  for (int i = 0; i < 500; ++i) {
    TargetSet previous;
    TargetSet current;
    for (const Eigen::Vector2d& point :
         {Eigen::Vector2d(5.0, 1.0), Eigen::Vector2d(9.0, -4.0), Eigen::Vector2d(3.0, 6.0),
          Eigen::Vector2d(8.0, 3.0), Eigen::Vector2d(2.0, -5.0)}) {
      add(previous, point + noise(generator));
      add(current, point + noise(generator));
    }
    const RegistrationResult result = register_icp(previous, current, {});
    credibility.add(result.motion, result.covariance, Eigen::Vector3d::Zero());
  }
  const Interval interval = anees_interval(credibility.count(), 3, 0.999);
  CHECK(credibility.anees() > interval.low);
  CHECK(credibility.anees() < interval.high);
}

TEST_CASE("ICP of a scan without targets is degenerate") {
  TargetSet none;
  TargetSet one;
  add(one, {5.0, 1.0});
  CHECK(register_icp(none, one, {}).status == RegistrationStatus::degenerate);
  CHECK(register_icp(one, none, {}).status == RegistrationStatus::degenerate);
}

TEST_CASE("ICP's covariance of one correspondence does not exist") {
  TargetSet one;
  add(one, {5.0, 1.0});
  CHECK_FALSE(icp_covariance(one, one, Eigen::Vector3d::Zero()).has_value());
}

TEST_CASE("ICP's covariance of symmetric points is the one that can be written down") {
  // Four points at distance 5, each with variance s^2 in both scans: the mean of four differences
  // of variance 2 s^2 each, and an angle from four lever arms of 5 m.
  TargetSet cross;
  for (const auto& [x_m, y_m] :
       {std::pair(5.0, 0.0), std::pair(0.0, 5.0), std::pair(-5.0, 0.0), std::pair(0.0, -5.0)}) {
    add(cross, {x_m, y_m});
  }
  const auto covariance = icp_covariance(cross, cross, Eigen::Vector3d::Zero());
  REQUIRE(covariance.has_value());
  const double variance = 2.0 * kStdM * kStdM / 4.0;
  CHECK((*covariance)(0, 0) == Approx(variance));
  CHECK((*covariance)(1, 1) == Approx(variance));
  CHECK((*covariance)(2, 2) == Approx(variance / 25.0));
  CHECK((*covariance)(0, 2) == Approx(0.0).margin(1e-12));
}
