// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Joint speed v and yaw rate w of several radars mounted at (l_x, l_y): least squares of V_x = v -
/// w l_y, V_y = w l_x. The noise includes errors of mounts and the vehicle's acceleration between
/// the scans.
class JointVelocity {
 public:
  explicit JointVelocity(const OdometryOptions& options);

  void add(const DopplerVelocity& velocity, const Pose2& vehicle_from_radar, double age_s);

  /// (v, w)
  [[nodiscard]] Eigen::Vector2d value() const;
  [[nodiscard]] Eigen::Matrix2d covariance() const;
  /// Squared normalised residuals per degree of freedom: 1 on average if all radars see the same
  /// motion.
  [[nodiscard]] double disagreement() const;
  [[nodiscard]] int radars() const { return radars_; }

 private:
  const OdometryOptions& options_;
  Eigen::Matrix2d information_ = Eigen::Matrix2d::Zero();
  Eigen::Vector2d weighted_ = Eigen::Vector2d::Zero();
  double squares_ = 0.0;
  int radars_ = 0;
};

}  // namespace cremed
