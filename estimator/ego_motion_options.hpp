// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "estimator/pose2.hpp"
#include "estimator/registration_options.hpp"

namespace cremed {

/// Which detections of a radar are used at all; bounds inclusive, in the radar's frame.
struct DetectionLimits {
  double min_range_m = 0.2;
  double max_range_m = 300.0;
  double max_abs_azimuth_rad = 3.1415926535897932;
  double min_rcs_dbm2 = -100.0;
};

/// What a radar's detections are put right by before they are used, as calibration finds it.
struct DetectionCorrection {
  /// Positions are turned ahead by so much of the yaw rate the sensor is told: see
  /// rotation_lead.hpp.
  double rotation_lead_s = 0.0;
  double doppler_offset_mps = 0.0;  ///< Systematic error of all Doppler, subtracted.
  double doppler_scale = 1.0;       ///< Factor on Doppler, once that is taken off.
  /// Factors on what the sensor reports.
  double range_std_factor = 1.0;
  double azimuth_std_factor = 1.0;
  double doppler_std_factor = 1.0;
};

/// Settings of one radar's ego-motion.
struct EgoMotionOptions {
  Pose2 vehicle_from_radar;  ///< Mount: pose of the radar in the vehicle frame (rear axle).
  DetectionLimits limits;
  DetectionCorrection correction;
  RegistrationOptions registration;
  int min_targets = 5;              ///< Fewer usable targets in a scan: too_few_targets.
  double max_gap_s = 0.5;           ///< Longer time between two scans: gap_too_long.
  double standstill_mps = 0.1;      ///< Speed up to it, and known as well as that: standing still.
  double max_speed_mps = 70.0;      ///< Faster estimates are implausible.
  double max_yaw_rate_radps = 3.0;  ///< Faster turns are implausible.
  double max_std_m = 1.0;           ///< Larger standard deviation of x or y: degenerate.
  double max_std_rad = 0.1;         ///< Larger standard deviation of yaw: degenerate.
};

}  // namespace cremed
