// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

/// Covariance of the change of a vehicle's velocity (m/s forward, m/s sideways, rad/s) in `time_s`.
/// `along_mps2`, `yaw_radps2`: standard deviations of its acceleration along each axis and of its
/// yaw acceleration.
inline Eigen::Matrix3d acceleration_covariance(double time_s, double along_mps2,
                                               double yaw_radps2) {
  const Eigen::Vector3d change = time_s * Eigen::Vector3d(along_mps2, along_mps2, yaw_radps2);
  return change.cwiseAbs2().asDiagonal();
}

}  // namespace cremed
