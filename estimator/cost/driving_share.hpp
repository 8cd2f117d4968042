// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace cremed {

/// Below this speed the systematic errors of a driving vehicle (of Doppler, mount and body) are
/// scaled in proportion to the speed, because they vanish when its body comes to rest.
inline constexpr double kDrivingMps = 1.0;

/// Factor on those errors: 0 at rest, 1 at kDrivingMps and above.
inline double driving_share(double speed_mps) {
  return std::min(std::abs(speed_mps) / kDrivingMps, 1.0);
}

/// Speed of a motion; a distance up to `noise_m` counts as 0.
inline double speed_beyond_noise_mps(const Eigen::Vector3d& motion, double noise_m, double dt_s) {
  return std::max(motion.head<2>().norm() - noise_m, 0.0) / dt_s;
}

}  // namespace cremed
