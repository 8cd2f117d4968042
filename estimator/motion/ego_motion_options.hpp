// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/scan/detection_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// Settings of one radar's ego-motion.
struct EgoMotionOptions {
  Pose2 vehicle_from_radar;  ///< Mount: pose of the radar in the vehicle frame (rear axle).
  DetectionLimits limits;
  DetectionCorrection correction;
  RegistrationOptions registration;
  int min_targets = 5;              ///< Fewer usable targets in a scan: too_few_targets.
  double max_gap_s = 0.5;           ///< Longer time between two scans: gap_too_long.
  double standstill_mps = 0.1;      ///< Largest speed, and sigma of it, of standing_still.
  double max_speed_mps = 70.0;      ///< Faster estimates are implausible.
  double max_yaw_rate_radps = 3.0;  ///< Faster turns are implausible.
  double max_std_m = 1.0;           ///< Larger standard deviation of x or y: degenerate.
  double max_std_rad = 0.1;         ///< Larger standard deviation of yaw: degenerate.

  /// Whether a motion (x_m, y_m, yaw_rad) in `dt_s` is plausible.
  [[nodiscard]] bool allows(const Eigen::Vector3d& motion, double dt_s) const {
    return motion.head<2>().norm() <= max_speed_mps * dt_s &&
           std::abs(motion.z()) <= max_yaw_rate_radps * dt_s;
  }

  bool operator==(const EgoMotionOptions&) const = default;
};

}  // namespace cremed
