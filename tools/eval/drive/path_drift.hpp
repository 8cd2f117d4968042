// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
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

/// Drift of the path over segments of one length.
struct PathDrift {
  double length_m = 0.0;
  std::size_t segments = 0;
  std::size_t across_gaps = 0;       ///< Segments omitted because of a gap.
  double translation_percent = 0.0;  ///< Mean over the segments; NaN if there is none.
  double rotation_deg_per_m = 0.0;   ///< Likewise.
};

inline constexpr std::array kDriftLengthsM{10.0, 20.0, 30.0, 40.0, 50.0,
                                           60.0, 70.0, 80.0, 90.0, 100.0};

/// Relative errors as KITTI's odometry benchmark defines them, over 10 to 100 m.
///
/// A segment of length L begins at any pose a and ends at the first pose b with more than L of true
/// path between them. With T the true and E the estimated pose of b in the frame of a, its error is
/// D = inverse(E) T: a translation |D| = |T - E| and a rotation |yaw of T - yaw of E|. Both are
/// divided by the true path from a to b and averaged over all segments of that length.
///
/// Two deviations from KITTI's program, because segments are ten times shorter: segments begin at
/// every pose instead of every tenth; and errors are divided by the true path instead of L, which
/// one scan's motion beyond L would make wrong by up to a tenth. A constant scale error s is thus s
/// at every L; a constant curvature error k on a straight road is k in rotation and about k L / 2
/// in translation.
std::vector<PathDrift> path_drift(const std::vector<PathPose>& path);

/// Over all segments of all lengths, KITTI's ranking figure; its length is 0.
PathDrift mean_drift(const std::vector<PathDrift>& drifts);

}  // namespace cremed
