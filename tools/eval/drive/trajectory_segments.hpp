// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/eval/drive/truth_noise.hpp"

namespace cremed {

/// Length of a segment by estimated distance, or by time. One of them is infinite.
struct SegmentLength {
  double way_m = 0.0;
  double time_s = 0.0;
};

/// "10 m" or "5 s".
std::string to_text(const SegmentLength& length);

/// Errors of the poses at the ends of all segments of one length. NaN if there is no segment.
struct SegmentErrors {
  SegmentLength length;
  std::size_t segments = 0;
  double anees = 0.0;             ///< Of the pose: 3 degrees of freedom.
  Eigen::Vector3d nees;           ///< Of x, y and yaw separately.
  Eigen::Vector3d rmse;           ///< (x_m, y_m, yaw_rad).
  double position_percent = 0.0;  ///< Mean distance from truth, in per cent of the path.
};

/// Errors and credibility of motions chained as independent: the pose after 10, 50 and 100 m and
/// after 1, 5, 10 and 30 s.
///
/// A segment begins at every fifth motion, or, for motions with common begins, at each begin (an
/// anchor), and ends at the first motion at or beyond its length. Segments with gaps and those
/// outside of truth's time are omitted. Segments of one length overlap, so they are not independent
/// samples.
std::vector<SegmentErrors> trajectory_segments(const std::vector<RecordedEstimate>& estimates,
                                               const TrueTrajectory& truth,
                                               const TruthNoise& noise);

}  // namespace cremed
