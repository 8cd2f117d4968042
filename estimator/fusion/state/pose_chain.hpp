// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

// Poses in the plane as (x_m, y_m, yaw_rad), and what they do to covariances.

/// Pose of b in the frame of a.
Eigen::Vector3d relative_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
/// Its derivatives by a (columns 0 to 2) and b, given the result.
Eigen::Matrix<double, 3, 6> relative_pose_jacobian(const Eigen::Vector3d& a,
                                                   const Eigen::Vector3d& relative);
/// The pose whose pose in the frame of a is `relative`.
Eigen::Vector3d composed_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& relative);
/// Covariance of that, if a and `relative` are independent.
Eigen::Matrix3d composed_covariance(const Eigen::Vector3d& a, const Eigen::Matrix3d& a_covariance,
                                    const Eigen::Vector3d& relative,
                                    const Eigen::Matrix3d& relative_covariance);
/// Covariance S of a pose's (x, y, yaw) in its own axes, in those that it is given in.
Eigen::Matrix3d turned_covariance(double yaw_rad, const Eigen::Matrix3d& covariance);

}  // namespace cremed
