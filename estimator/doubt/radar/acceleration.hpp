// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "cremed/estimator/motion/vehicle_limits.hpp"

namespace cremed {

/// Whether a radar's velocity by Doppler changed in `time_s` by more than a vehicle's can and the
/// noise of two velocities: a fault begins or ends.
inline bool is_doppler_step(double change_mps, double time_s) {
  constexpr double kMaxNoiseMps = 1.5;
  return std::abs(change_mps) > kMaxAccelerationMps2 * std::abs(time_s) + kMaxNoiseMps;
}

/// Covariance of the change of a vehicle's velocity (m/s forward, m/s sideways, rad/s) in `time_s`.
/// `along_mps2`, `yaw_radps2`: standard deviations of its acceleration along each axis and of its
/// yaw acceleration.
inline Eigen::Matrix3d acceleration_covariance(double time_s, double along_mps2,
                                               double yaw_radps2) {
  const Eigen::Vector3d change = time_s * Eigen::Vector3d(along_mps2, along_mps2, yaw_radps2);
  return change.cwiseAbs2().asDiagonal();
}

}  // namespace cremed
