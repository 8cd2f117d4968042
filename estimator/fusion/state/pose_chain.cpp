// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/pose_chain.hpp"

#include <cmath>

#include "cremed/estimator/scan/rotation.hpp"

namespace cremed {
namespace {

Eigen::Matrix3d rotation(double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  Eigen::Matrix3d result;
  result << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return result;
}

}  // namespace

Eigen::Vector3d relative_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector2d moved = Rotation(-a.z()) * (b - a).head<2>();
  return {moved.x(), moved.y(), b.z() - a.z()};
}

Eigen::Matrix<double, 3, 6> relative_pose_jacobian(const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& relative) {
  Eigen::Matrix<double, 3, 6> result;
  result.rightCols<3>() = rotation(-a.z());
  result.leftCols<3>() = -rotation(-a.z());
  result.col(2) += Eigen::Vector3d(relative.y(), -relative.x(), 0.0);
  return result;
}

Eigen::Vector3d composed_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& relative) {
  const Eigen::Vector2d moved = Rotation(a.z()) * relative.head<2>();
  return {a.x() + moved.x(), a.y() + moved.y(), a.z() + relative.z()};
}

Eigen::Matrix<double, 3, 6> composed_pose_jacobian(const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& relative) {
  const Eigen::Vector2d moved = Rotation(a.z()) * relative.head<2>();
  Eigen::Matrix<double, 3, 6> result;
  result.leftCols<3>().setIdentity();
  result.col(2) += Eigen::Vector3d(-moved.y(), moved.x(), 0.0);
  result.rightCols<3>() = rotation(a.z());
  return result;
}

}  // namespace cremed
