// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
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
  Eigen::Vector3d rmse = Eigen::Vector3d::Zero();  ///< (x_m, y_m, yaw_rad).
  double position_percent = 0.0;  ///< Mean distance from truth, in per cent of the path.
  std::size_t chains = 0;         ///< Those with a covariance.
  double anees = 0.0;             ///< Of their pose: 3 degrees of freedom.
  Eigen::Vector3d nees = Eigen::Vector3d::Zero();  ///< Of x, y and yaw separately.
};

/// Errors and credibility of the pose after 10, 50 and 100 m and after 1, 5, 10 and 30 s.
///
/// Errors after a time are those of the steps over every window (window_errors). Covariances are
/// those of chains: the estimates chained as independent. A chain begins at every anchor, the only
/// time without covariance, or, for estimates from scan to scan, at the first one in each window.
/// It ends at the estimate nearest to its begin plus that time, or at the first one at or beyond a
/// distance; errors after a distance are those of the chains too. Chains with gaps and those
/// outside of truth's time are omitted. Segments of one length overlap, so they are not independent
/// samples.
std::vector<SegmentErrors> trajectory_segments(const RecordedOdometry& odometry,
                                               const TrueTrajectory& truth, const TruthNoise& noise,
                                               std::int64_t first_window_us);

/// Those after 1, 5, 10 or 30 s; throws std::invalid_argument for another time.
const SegmentErrors& after_time(const std::vector<SegmentErrors>& segments, double time_s);

}  // namespace cremed
