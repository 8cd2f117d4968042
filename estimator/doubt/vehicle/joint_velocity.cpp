// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/joint_velocity.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
JointVelocity::JointVelocity(const OdometryOptions& options) : options_(options) {
  information_(1, 1) = 1.0 / squared(options.start_yaw_rate_std_radps);
}

void JointVelocity::add(const DopplerVelocity& velocity, const Pose2& vehicle_from_radar,
                        double age_s) {
  const double speed = velocity.velocity_mps.norm();
  const double changed = squared(SharedErrorOptions().acceleration_std_mps2 * age_s);
  Eigen::Matrix2d noise = velocity.covariance;
  noise(0, 0) += squared(options_.doppler_x.std) + squared(options_.offset.std) + changed;
  noise(1, 1) +=
      squared(options_.doppler_y.std) + changed +
      squared(speed) * (squared(options_.mount_yaw_std_rad) + squared(options_.slip_std_rad));
  Eigen::Matrix2d by;
  by << 1.0, -vehicle_from_radar.y_m, 0.0, vehicle_from_radar.x_m;
  const Eigen::Matrix2d weight = noise.inverse();
  information_ += by.transpose() * weight * by;
  weighted_ += by.transpose() * weight * velocity.velocity_mps;
  squares_ += velocity.velocity_mps.dot(weight * velocity.velocity_mps);
  ++radars_;
}

Eigen::Vector2d JointVelocity::value() const { return information_.inverse() * weighted_; }

Eigen::Matrix2d JointVelocity::covariance() const { return information_.inverse(); }

double JointVelocity::disagreement() const {
  // Two measurements for each radar and one prior, less two unknowns.
  const double freedom = 2.0 * radars_ - 1.0;
  return std::max(squares_ - weighted_.dot(value()), 0.0) / freedom;
}

}  // namespace cremed
