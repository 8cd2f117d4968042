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

/// Position at the end of an estimate.
struct PathPose {
  std::int64_t utime_us = 0;
  Pose2 truth;
  Pose2 estimate;         ///< The chained estimates, beginning at the first true pose.
  double driven_m = 0.0;  ///< True path length since the first pose.
  std::size_t gaps = 0;   ///< Gaps before this pose.
};

/// Chains a source's estimates. A gap is where an estimate does not begin at the end of the one
/// before: a pose follows at its begin, moved by the true motion, so that drift is due to estimates
/// only. Estimates outside of truth's time are omitted.
std::vector<PathPose> driven_path(const std::vector<RecordedEstimate>& estimates,
                                  const TrueTrajectory& truth);

}  // namespace cremed
