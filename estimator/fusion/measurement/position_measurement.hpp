// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// y and yaw of the registered motion between a keyframe and the current scan of a radar, with (dx,
/// dy, dpsi) the pose of the scan's clone in the frame of the keyframe's clone; (11) of the README:
///
///     z_y = dy - d (dx - dpsi l_y) + q dx
///     z_psi = dpsi (1 + g + g_c) + r dx
///
/// d mount yaw, q lateral error over distance, g scale of yaw (g_c common to all radars), r error
/// of yaw over distance. x is not used, because Doppler measures it far better.
struct PositionMeasurement {
  const OdometryState& state;
  std::size_t radar;
  std::size_t keyframe;

  [[nodiscard]] LinearMeasurement linearise(const Eigen::Vector3d& motion) const;
  /// The expected result (x, y, yaw) of a registration, if the scan is at `scan_pose`.
  [[nodiscard]] Eigen::Vector3d expected_motion(const Eigen::Vector3d& scan_pose) const;

 private:
  [[nodiscard]] double at(int error) const;
  [[nodiscard]] double yaw_scale() const;
  [[nodiscard]] Eigen::Vector3d keyframe_pose() const;
  [[nodiscard]] Eigen::Vector2d apparent(const Eigen::Vector3d& relative) const;
};

}  // namespace cremed
