// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/output/fused_motion.hpp"

using namespace cremed;

namespace {

constexpr double kStandstillMps = 0.05;

/// Over 75 ms.
Odometry odometry(OdometryStatus status, double x_m) {
  Odometry result;
  result.status = status;
  result.utime_before_us = 1'000'000;
  result.utime_us = 1'075'000;
  result.motion = {x_m, 0.0, 0.001};
  result.motion_covariance.setIdentity();
  return result;
}

MotionStatus status_of(OdometryStatus status, double x_m) {
  return fused_motion(odometry(status, x_m), 1, kStandstillMps).status;
}

}  // namespace

TEST_CASE("an output of the odometry is an estimate while it is ok or stands still") {
  for (const auto status : {OdometryStatus::ok, OdometryStatus::standing_still}) {
    const EgoMotion fused = fused_motion(odometry(status, 0.001), 17, kStandstillMps);
    CHECK(fused.has_estimate());
    CHECK(fused.motion.x() == 0.001);
    CHECK(fused.covariance.isIdentity());
    CHECK(fused.targets == 17);
  }
  for (const auto status : {OdometryStatus::initialising, OdometryStatus::predicted,
                            OdometryStatus::ambiguous, OdometryStatus::lost}) {
    const EgoMotion fused = fused_motion(odometry(status, 0.001), 17, kStandstillMps);
    CHECK_FALSE(fused.has_estimate());
    CHECK(fused.motion.array().isNaN().all());
  }
}

TEST_CASE("a motion to a stop is no standing still") {
  CHECK(status_of(OdometryStatus::standing_still, 0.003) == MotionStatus::standing_still);
  CHECK(status_of(OdometryStatus::standing_still, 0.006) == MotionStatus::ok);
}

TEST_CASE("a correction of the pose is no motion") {
  CHECK(status_of(OdometryStatus::ok, 4.0) == MotionStatus::ok);  // 53 m/s.
  for (const auto status : {OdometryStatus::ok, OdometryStatus::standing_still}) {
    // Seen in a soak test: at rest, another radar's scan 1 ms later.
    Odometry corrected = odometry(status, -0.105);
    corrected.utime_before_us = corrected.utime_us - 1009;
    const EgoMotion fused = fused_motion(corrected, 1, kStandstillMps);
    CHECK(fused.status == MotionStatus::implausible);
    CHECK(fused.motion.array().isNaN().all());
    CHECK(fused.covariance.array().isNaN().all());
  }
  Odometry turned = odometry(OdometryStatus::ok, 0.0);
  turned.motion.z() = -0.4;
  CHECK(fused_motion(turned, 1, kStandstillMps).status == MotionStatus::implausible);
}
