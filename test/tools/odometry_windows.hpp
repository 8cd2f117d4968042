// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/scan/degrees.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed::test {

/// Errors of the pose since the start over every window of a length, begun 0.5 s apart.
struct WindowErrors {
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

inline WindowErrors window_errors(const std::vector<Odometry>& odometries,
                                  const TrueTrajectory& truth, double window_s) {
  constexpr std::int64_t kStepUs = 500'000;
  std::vector<std::int64_t> times_us;
  std::vector<Pose2> poses;
  for (const Odometry& odometry : odometries) {
    if (odometry.status != OdometryStatus::initialising) {
      times_us.push_back(odometry.utime_us);
      poses.push_back({odometry.odom_pose.x(), odometry.odom_pose.y(), odometry.odom_pose.z()});
    }
  }
  const TrueTrajectory driven(times_us, poses);
  const auto length_us = static_cast<std::int64_t>(window_s * 1e6);
  WindowErrors errors;
  for (std::int64_t from_us = times_us.front() + kStepUs; from_us + length_us <= times_us.back();
       from_us += kStepUs) {
    const auto estimate = driven.motion(from_us, from_us + length_us);
    const auto wanted = truth.motion(from_us, from_us + length_us);
    if (estimate && wanted) {
      const Eigen::Vector3d error = estimation_error(*estimate, *wanted);
      errors.yaw_deg += squared(kDegPerRad * error.z());
      errors.path +=
          error.head<2>().norm() / std::max(way_m(truth, from_us, from_us + length_us), 1.0);
      ++errors.windows;
    }
  }
  errors.yaw_deg = std::sqrt(errors.yaw_deg / errors.windows);
  errors.path /= errors.windows;
  return errors;
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
