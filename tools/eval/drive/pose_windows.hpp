// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// Neighbouring windows begin this far apart.
inline constexpr std::int64_t kWindowStepUs = 500'000;

/// Poses of chained motions, in the frame of the first. A gap is where a motion does not begin at
/// the end of the one before.
TrueTrajectory chained_poses(const std::vector<RecordedEstimate>& steps);

/// Errors at the ends of all windows of one length. NaN if there is none.
struct WindowErrors {
  std::size_t windows = 0;
  Eigen::Vector3d rmse = Eigen::Vector3d::Zero();  ///< (x_m, y_m, yaw_rad).
  double position_percent = 0.0;  ///< Mean distance from truth, in per cent of the true path.
};

/// Begin of the first window of a drive: one step after both truth and any of the sources have
/// begun.
std::int64_t first_window_us(const std::vector<RecordedOdometry>& sources,
                             const TrueTrajectory& truth);

/// Every window of that length, begun kWindowStepUs apart from `first_us` on, that both cover: the
/// poses without a gap, truth at both ends and without a gap of more than a second.
WindowErrors window_errors(const TrueTrajectory& poses, const TrueTrajectory& truth,
                           std::int64_t first_us, std::int64_t length_us);

}  // namespace cremed
