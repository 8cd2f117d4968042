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

/// How long a segment is: by the estimated way, or by time. One of them is infinite.
struct SegmentLength {
  double way_m = 0.0;
  double time_s = 0.0;
};

/// "10 m" or "5 s".
std::string to_text(const SegmentLength& length);

/// The poses at the ends of all segments of one length against truth. NaN if there is no segment.
struct SegmentErrors {
  SegmentLength length;
  std::size_t segments = 0;
  double anees = 0.0;             ///< Of the pose: 3 degrees of freedom.
  Eigen::Vector3d nees;           ///< Of x, y and yaw alone.
  Eigen::Vector3d rmse;           ///< (x_m, y_m, yaw_rad).
  double position_percent = 0.0;  ///< Mean distance from truth, of the way.
};

/// How wrong motions are that are chained as if they were independent, and whether their
/// covariances, added up so, say it: the pose after 10, 50 and 100 m and after 1, 5, 10 and 30 s.
///
/// A segment begins at every fifth motion, or, where motions share their begins, at each begin (an
/// anchor), and ends at the first motion at or beyond its length. Those with a gap in them and
/// those that truth does not cover are left out. Segments of one length overlap: their number says
/// little about how sure the figures are.
std::vector<SegmentErrors> trajectory_segments(const std::vector<RecordedEstimate>& estimates,
                                               const TrueTrajectory& truth,
                                               const TruthNoise& noise);

}  // namespace cremed
