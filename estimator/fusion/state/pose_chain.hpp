// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

// Relative and composed poses in the plane, (x_m, y_m, yaw_rad), and their derivatives.

/// Pose of b in the frame of a.
Eigen::Vector3d relative_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// Its derivatives by a (columns 0 to 2) and b, given the result.
Eigen::Matrix<double, 3, 6> relative_pose_jacobian(const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& relative);
/// Pose of b, if `relative` is its pose in the frame of a.
Eigen::Vector3d composed_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& relative);
/// Its derivatives by a (columns 0 to 2) and `relative`.
Eigen::Matrix<double, 3, 6> composed_pose_jacobian(const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& relative);

}  // namespace cremed
