// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Least squares for the vehicle's motion x = (v, w, slip): information H, H x, and x' H x of the
/// measurements.
struct MotionSums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  double squares = 0.0;
  /// Covariance of H x by the random part of the errors; the rest stays the same for seconds.
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& derivative, double value, double variance,
           double random_variance = 0.0);
  /// Velocity of a radar at this mount, V = (v - w l_y, w l_x + s v), in the axes of the vehicle,
  /// with its covariance: that of all errors, and of the random ones.
  void add_velocity(const Pose2& mount, const Eigen::Vector2d& mps,
                    const Eigen::Matrix2d& covariance, const Eigen::Matrix2d& random);
  void add(const MotionSums& other);
  [[nodiscard]] Eigen::Vector3d solution() const;
  [[nodiscard]] double chi_square() const;
  [[nodiscard]] Eigen::Matrix3d covariance() const;  ///< Of the solution,
  /// and by the random part of the errors.
  [[nodiscard]] Eigen::Matrix3d random_covariance() const;
};

}  // namespace cremed
