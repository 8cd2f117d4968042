// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/drive.hpp"

#include <cmath>

namespace cremed::simulation {

EgoMotionOptions options_at(const Pose2& mount) {
  EgoMotionOptions options;
  options.vehicle_from_radar = mount;
  return options;
}

Drive::Drive(const Eigen::Vector3d& velocity, const Pose2& mount, std::uint64_t seed,
             std::size_t point_count)
    : velocity_(velocity), mount_(mount), random_(seed) {
  points_ = scatter(random_, point_count, 4.0, 60.0, numeric::radians(180.0), 1.0);
}

void Drive::renew(double share) {
  for (Eigen::Vector2d& point : points_) {
    if (uniform(random_, 0.0, 1.0) < share) {
      point = scatter(random_, 1, 4.0, 60.0, numeric::radians(180.0), 0.0)[0];
    }
  }
}

void Drive::pass(std::int64_t time_us) {
  stamp_us_ += time_us;
  const double time_s = static_cast<double>(time_us) * 1e-6;
  const Eigen::Vector3d change(acceleration_mps2_ * time_s, 0.0, 0.0);
  const Eigen::Vector3d motion = (velocity_ + 0.5 * change) * time_s;
  velocity_ += change;
  for (Eigen::Vector2d& point : points_) {
    point = seen_from(motion, point);
  }
}

RadarScan Drive::next() {
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

Eigen::Vector3d Drive::motion_per_period() const {
  return velocity_ * (static_cast<double>(kPeriodUs) * 1e-6);
}

}  // namespace cremed::simulation
