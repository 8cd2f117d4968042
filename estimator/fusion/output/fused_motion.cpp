// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/output/fused_motion.hpp"

#include <array>

#include "cremed/estimator/motion/ego_motion_options.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

EgoMotion fused_motion(const Odometry& odometry, std::size_t targets, double standstill_mps) {
  static constexpr std::array<MotionStatus, kOdometryStatusCount> kStatuses{
      MotionStatus::ok,           MotionStatus::standing_still, MotionStatus::no_reference,
      MotionStatus::gap_too_long, MotionStatus::ambiguous,      MotionStatus::gap_too_long};
  EgoMotion fused;
  fused.utime_start_us = odometry.utime_before_us;
  fused.utime_us = odometry.utime_us;
  fused.status = kStatuses[static_cast<std::size_t>(odometry.status)];
  fused.targets = static_cast<int>(targets);
  const double dt_s = seconds_between(fused.utime_start_us, fused.utime_us);
  if (fused.has_estimate() && !EgoMotionOptions().allows(odometry.motion, dt_s)) {
    fused.status = MotionStatus::implausible;
  }
  if (fused.has_estimate()) {
    fused.motion = odometry.motion;
    fused.covariance = odometry.motion_covariance;
    if (fused.motion.head<2>().norm() > standstill_mps * dt_s) {
      fused.status = MotionStatus::ok;
    }
  }
  return fused;
}

}  // namespace cremed
