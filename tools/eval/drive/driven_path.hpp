// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// Where the vehicle was at an end of an estimate.
struct PathPose {
  std::int64_t utime_us = 0;
  Pose2 truth;
  Pose2 estimate;         ///< The estimates put together, beginning at the first true pose.
  double driven_m = 0.0;  ///< True path since the first pose, straight from pose to pose.
  std::size_t gaps = 0;   ///< Gaps before it.
};

/// Puts a source's estimates together. Where one does not begin where the one before ended there is
/// a gap: a pose at its begin follows, moved on as truth moved, so that what the path drifts is the
/// estimates' doing alone. Estimates outside of truth's time are left out.
std::vector<PathPose> driven_path(const std::vector<RecordedEstimate>& estimates,
                                  const TrueTrajectory& truth);

}  // namespace cremed
