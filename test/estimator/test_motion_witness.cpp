// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/motion_witness.hpp"

namespace cremed {
namespace {

/// Odometry at 10 m/s in a turn, 50 ms before the motion ends.
Odometry known() {
  Odometry odometry;
  odometry.utime_us = 1'000'000;
  odometry.status = OdometryStatus::ok;
  odometry.twist = {10.0, 0.0, 0.2};
  odometry.twist_covariance = Eigen::Vector3d(0.0025, 0.01, 0.0001).asDiagonal();
  return odometry;
}

EgoMotion motion_at(double speed_mps, double yaw_rate_radps) {
  constexpr double kSpanS = 0.1;
  EgoMotion motion;
  motion.utime_start_us = 950'000;
  motion.utime_us = 1'050'000;
  motion.status = MotionStatus::ok;
  motion.motion = Eigen::Vector3d(speed_mps, 0.0, yaw_rate_radps) * kSpanS;
  motion.covariance = Eigen::Vector3d(1e-5, 0.0, 1e-6).asDiagonal();
  return motion;
}

TEST_CASE("changes within a vehicle's limits are no contradiction, larger ones are") {
  // 5 sigma of both are 0.30 m/s and 0.071 rad/s; the mean distance of the interval's moments from
  // the odometry's is 25 ms, which 10 m/s^2 and 2 rad/s^2 make 0.25 m/s and 0.05 rad/s.
  CHECK_FALSE(contradicts(known(), motion_at(10.0, 0.2)));
  CHECK_FALSE(contradicts(known(), motion_at(10.5, 0.2)));
  CHECK_FALSE(contradicts(known(), motion_at(9.5, 0.31)));
  CHECK(contradicts(known(), motion_at(10.65, 0.2)));
  CHECK(contradicts(known(), motion_at(9.35, 0.2)));
  CHECK(contradicts(known(), motion_at(10.0, 0.35)));
  // Targets that move along; a reversed mount.
  CHECK(contradicts(known(), motion_at(0.0, 0.2)));
  CHECK(contradicts(known(), motion_at(-10.0, 0.2)));
}

TEST_CASE("older odometry allows larger changes, and after 0.3 s any") {
  EgoMotion later = motion_at(11.0, 0.2);
  CHECK(contradicts(known(), later));
  later.utime_start_us += 100'000;
  later.utime_us += 100'000;
  CHECK_FALSE(contradicts(known(), later));
  EgoMotion much_later = motion_at(-10.0, 0.2);
  much_later.utime_start_us += 300'000;
  much_later.utime_us += 300'000;
  CHECK_FALSE(contradicts(known(), much_later));
}

TEST_CASE("uncertain odometry and motions without estimate are no contradiction") {
  Odometry unsure = known();
  unsure.status = OdometryStatus::initialising;
  unsure.twist_covariance *= 1e4;
  CHECK_FALSE(contradicts(unsure, motion_at(0.0, 0.2)));
  const EgoMotion nothing = withdrawn(motion_at(0.0, 0.2));
  CHECK_FALSE(contradicts(known(), nothing));
  CHECK(nothing.status == MotionStatus::ambiguous);
  CHECK(nothing.motion.array().isNaN().all());
  CHECK(nothing.covariance.array().isNaN().all());
}

}  // namespace
}  // namespace cremed
