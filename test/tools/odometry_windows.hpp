// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/pose_windows.hpp"
#include "tools/eval/drive/recorded_states.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed::test {

/// Errors of the pose since the start over every window of a length, begun 0.5 s apart.
struct DriftErrors {
  int windows = 0;
  double yaw_deg = 0.0;  ///< RMS.
  double path = 0.0;     ///< Mean position error, as a share of the way.
};

inline double way_m(const TrueTrajectory& truth, std::int64_t from_us, std::int64_t to_us) {
  constexpr std::int64_t kStepUs = 100'000;
  double sum = 0.0;
  for (std::int64_t at_us = from_us; at_us < to_us; at_us += kStepUs) {
    sum += truth.motion(at_us, at_us + kStepUs).value_or(Eigen::Vector3d::Zero()).head<2>().norm();
  }
  return sum;
}

inline DriftErrors drift_errors(const std::vector<Odometry>& odometries,
                                const TrueTrajectory& truth, double window_s) {
  const RecordedOdometry odometry = recorded_states(odometries).odometry;
  const WindowErrors errors =
      window_errors(chained_poses(odometry.steps()), truth, first_window_us({odometry}, truth),
                    std::llround(1e6 * window_s));
  return {static_cast<int>(errors.windows), kDegPerRad * errors.rmse.z(),
          0.01 * errors.position_percent};
}

/// The last pose of each anchor's segment against truth, from a time on.
inline Credibility segments(const std::vector<Odometry>& odometries, const TrueTrajectory& truth,
                            std::int64_t from_us = 0) {
  Credibility credibility(3);
  for (std::size_t i = 1; i < odometries.size(); ++i) {
    const Odometry& last = odometries[i - 1];
    const auto wanted = truth.motion(last.utime_anchor_us, last.utime_us);
    if (odometries[i].utime_anchor_us != last.utime_anchor_us && last.utime_anchor_us >= from_us &&
        wanted) {
      credibility.add(last.pose, last.covariance, *wanted);
    }
  }
  return credibility;
}

}  // namespace cremed::test
