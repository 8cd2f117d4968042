// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "cremed/estimator/motion/ego_motion_options.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::simulation {

inline EgoMotionOptions options_at(const Pose2& mount) {
  EgoMotionOptions options;
  options.vehicle_from_radar = mount;
  return options;
}

/// A radar that drives at constant velocity, or straight on at constant acceleration, through
/// static points.
class Drive {
 public:
  static constexpr double kPeriodS = 0.1;
  static constexpr std::int64_t kPeriodUs = 100000;

  Drive(const Eigen::Vector3d& velocity, const Pose2& mount, std::uint64_t seed = 1,
        std::size_t point_count = 60)
      : velocity_(velocity), mount_(mount), random_(seed) {
    points_ = scatter(random_, point_count, 4.0, 60.0, numeric::radians(180.0), 1.0);
  }

  /// Sets the vehicle's velocity: (m/s forward, m/s left, rad/s).
  void set_velocity(const Eigen::Vector3d& velocity) { velocity_ = velocity; }
  /// Sets the acceleration along x.
  void set_acceleration(double acceleration_mps2) { acceleration_mps2_ = acceleration_mps2; }
  void set_noise(const Noise& noise) { noise_ = noise; }
  void set_half_view(double half_view_rad) { half_view_rad_ = half_view_rad; }

  /// Moves a share of the points to random places.
  void renew(double share) {
    for (Eigen::Vector2d& point : points_) {
      if (uniform(random_, 0.0, 1.0) < share) {
        point = scatter(random_, 1, 4.0, 60.0, numeric::radians(180.0), 0.0)[0];
      }
    }
  }

  /// Drives on without a scan.
  void pass(std::int64_t time_us = kPeriodUs) {
    stamp_us_ += time_us;
    const double time_s = static_cast<double>(time_us) * 1e-6;
    const Eigen::Vector3d change(acceleration_mps2_ * time_s, 0.0, 0.0);
    const Eigen::Vector3d motion = (velocity_ + 0.5 * change) * time_s;
    velocity_ += change;
    for (Eigen::Vector2d& point : points_) {
      point = seen_from(motion, point);
    }
  }

  /// Returns a noisy scan, then drives on for a period.
  RadarScan next() {
    Detections detections;
    for (const Eigen::Vector2d& point : points_) {
      const Detection detection = observe(point, velocity_, mount_, noise_);
      if (std::abs(detection.azimuth_rad) < half_view_rad_) {
        detections.push_back(detection);
      }
    }
    perturb(detections, random_);
    RadarScan result = scan(detections, stamp_us_);
    pass();
    return result;
  }

  [[nodiscard]] Eigen::Vector3d motion_per_period() const {
    return velocity_ * (static_cast<double>(kPeriodUs) * 1e-6);
  }

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
