// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "test/tools/drawn_sweep.hpp"
#include "tools/eval/drive/submap_odometry.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr double kPeriodS = 0.075;

struct Driven {
  Pose2 submap;
  Pose2 velocity;  ///< From the velocity alone, which has a constant error.
  Pose2 truth;
  double nees = 0.0;  ///< Of the motions.
};

/// Along a bend; the velocity's yaw rate is too large by `yaw_rate_error_radps`.
Driven drive_bend(unsigned seed, const Eigen::Vector3d& twist, double yaw_rate_error_radps) {
  constexpr int kSweeps = 60;
  DrawnWorld world(seed, 400);
  SubmapOdometry odometry{{}};
  Driven driven;
  const Eigen::Vector3d motion = kPeriodS * twist;
  const Eigen::Vector3d wrong = motion + Eigen::Vector3d(0.0, 0.0, kPeriodS * yaw_rate_error_radps);
  for (int i = 0; i < kSweeps; ++i) {
    driven.truth = moved(driven.truth, motion);
    driven.velocity = moved(driven.velocity, wrong);
    const Sweep sweep = world.sweep(driven.truth, twist, 0.2, 4);
    const auto velocity = kellner_velocity(sweep.targets);
    REQUIRE(velocity);
    const auto result = odometry.update(sweep, *velocity, wrong, kPeriodS);
    // The first sweep has no map.
    driven.submap = moved(driven.submap, i == 0 ? motion : result.motion);
    const Eigen::Vector3d error = result.motion - motion;
    driven.nees += error.dot(result.covariance.ldlt().solve(error)) / 3.0 / kSweeps;
  }
  return driven;
}

}  // namespace

TEST_CASE("A submap keeps the way that a wrong yaw rate leaves") {
  const Eigen::Vector3d twist =
      GENERATE(Eigen::Vector3d(10.0, 0.0, 0.0), Eigen::Vector3d(8.0, 0.0, 0.3));
  double submap_rad = 0.0;
  for (unsigned seed = 0; seed < 3; ++seed) {
    const Driven driven = drive_bend(seed, twist, 0.03);
    const double velocity_rad = driven.velocity.yaw_rad - driven.truth.yaw_rad;
    CHECK(std::abs(velocity_rad) > 0.1);
    submap_rad = std::max(submap_rad, std::abs(driven.submap.yaw_rad - driven.truth.yaw_rad));
    CHECK(driven.nees < 3.0);
  }
  CHECK(submap_rad < 0.035);
}

TEST_CASE("Without anything to be matched the motion is that by velocity") {
  DrawnWorld world(1, 400);
  const Eigen::Vector3d twist(10.0, 0.0, 0.1);
  const Sweep sweep = world.sweep({}, twist, 0.2, 4);
  SubmapOdometry odometry{{}};
  const Eigen::Vector3d motion = kPeriodS * twist;
  const auto result = odometry.update(sweep, *kellner_velocity(sweep.targets), motion, kPeriodS);
  CHECK((result.motion - motion).norm() < 1e-9);
  CHECK(result.covariance.diagonal().minCoeff() > 0.0);
}
