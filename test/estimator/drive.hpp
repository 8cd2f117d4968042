// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/motion/ego_motion_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::simulation {

EgoMotionOptions options_at(const Pose2& mount);

/// A radar that drives at constant velocity, or straight on at constant acceleration, through
/// static points.
class Drive {
 public:
  static constexpr double kPeriodS = 0.1;
  static constexpr std::int64_t kPeriodUs = 100000;

  Drive(const Eigen::Vector3d& velocity, const Pose2& mount, std::uint64_t seed = 1,
        std::size_t point_count = 60);

  /// Sets the vehicle's velocity: (m/s forward, m/s left, rad/s).
  void set_velocity(const Eigen::Vector3d& velocity) { velocity_ = velocity; }
  /// Sets the acceleration along x.
  void set_acceleration(double acceleration_mps2) { acceleration_mps2_ = acceleration_mps2; }
  void set_noise(const Noise& noise) { noise_ = noise; }
  void set_half_view(double half_view_rad) { half_view_rad_ = half_view_rad; }

  /// Moves a share of the points to random places.
  void renew(double share);

  /// Drives on without a scan.
  void pass(std::int64_t time_us = kPeriodUs);

  /// Returns a noisy scan, then drives on for a period.
  RadarScan next();

  [[nodiscard]] Eigen::Vector3d motion_per_period() const;

 private:
  Eigen::Vector3d velocity_;
  double acceleration_mps2_ = 0.0;
  Pose2 mount_;
  Noise noise_{0.1, 0.005, 0.1};
  double half_view_rad_ = numeric::radians(60.0);
  Random random_;
  Points points_;
  std::int64_t stamp_us_ = 1700000000000000;
};

}  // namespace cremed::simulation
