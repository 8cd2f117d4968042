// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

/// Covariance of what a vehicle's velocity (m/s forward, m/s sideways, rad/s) changes by in
/// `time_s`, from standard deviations of its acceleration along an axis and of its yaw.
inline Eigen::Matrix3d acceleration_covariance(double time_s, double along_mps2,
                                               double yaw_radps2) {
  const Eigen::Vector3d change = time_s * Eigen::Vector3d(along_mps2, along_mps2, yaw_radps2);
  return change.cwiseAbs2().asDiagonal();
}

}  // namespace cremed
