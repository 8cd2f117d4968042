// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

inline Eigen::Vector2d position(const Target& target) { return {target.x_m, target.y_m}; }

inline Eigen::Matrix2d covariance_matrix(const Target& target) {
  const Symmetric2& c = target.covariance_m2;
  Eigen::Matrix2d matrix;
  matrix << c.xx, c.xy, c.xy, c.yy;
  return matrix;
}

inline Eigen::Matrix2d rotation_matrix(double yaw_rad) {
  return Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
}

}  // namespace cremed
