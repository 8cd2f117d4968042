// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Least squares for the vehicle's motion x = (v, w, slip), of measurements z = J x with weight W:
/// sums of J' W J (information), J' W z (weighted) and z' W z (squares).
struct MotionSums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  double squares = 0.0;
  /// Covariance of `weighted` by the noise of targets alone, which is new in each scan; other
  /// errors last for seconds.
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& derivative, double value, double variance,
           double random_variance = 0.0);
  /// Velocity of a radar at this mount, V = (v - w l_y, w l_x + s v), in the axes of the vehicle.
  /// `covariance`: of all errors, `random`: of the random ones.
  void add_velocity(const Pose2& mount, const Eigen::Vector2d& mps,
                    const Eigen::Matrix2d& covariance, const Eigen::Matrix2d& random);
  void add(const MotionSums& other);
  [[nodiscard]] Eigen::Vector3d solution() const;
  [[nodiscard]] double chi_square() const;
  /// Covariance of the solution.
  [[nodiscard]] Eigen::Matrix3d covariance() const;
  /// The part of it by random errors.
  [[nodiscard]] Eigen::Matrix3d random_covariance() const;
};

}  // namespace cremed
