// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/fusion/fused_motion.hpp"

#include <array>

namespace cremed {

EgoMotion fused_motion(const Odometry& odometry, std::size_t targets) {
  static constexpr std::array<MotionStatus, kOdometryStatusCount> kStatuses{
      MotionStatus::ok,           MotionStatus::standing_still, MotionStatus::no_reference,
      MotionStatus::gap_too_long, MotionStatus::ambiguous,      MotionStatus::gap_too_long};
  EgoMotion fused;
  fused.utime_start_us = odometry.utime_before_us;
  fused.utime_us = odometry.utime_us;
  fused.status = kStatuses[static_cast<std::size_t>(odometry.status)];
  fused.targets = static_cast<int>(targets);
  if (fused.has_estimate()) {
    fused.motion = odometry.motion;
    fused.covariance = odometry.motion_covariance;
  }
  return fused;
}

}  // namespace cremed
