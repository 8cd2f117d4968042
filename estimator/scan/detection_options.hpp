// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Limits of the detections that are used: inclusive, in the radar's frame.
struct DetectionLimits {
  double min_range_m = 0.2;
  double max_range_m = 300.0;
  double max_abs_azimuth_rad = 3.1415926535897932;
  double min_rcs_dbm2 = -100.0;

  bool operator==(const DetectionLimits&) const = default;
};

/// Corrections, found by calibration, that are applied to a radar's detections before use.
struct DetectionCorrection {
  /// Positions are turned ahead by this time times the yaw rate that the sensor is sent: see
  /// rotation_lead.hpp.
  double rotation_lead_s = 0.0;
  /// Factor on the azimuth, in the radar's frame, after that: true over reported.
  double azimuth_scale = 1.0;
  double doppler_offset_mps = 0.0;  ///< Subtracted from all Doppler.
  double doppler_scale = 1.0;       ///< Factor on Doppler after that.
  /// Factors on the standard deviations that the sensor reports.
  double range_std_factor = 1.0;
  double azimuth_std_factor = 1.0;
  double doppler_std_factor = 1.0;

  bool operator==(const DetectionCorrection&) const = default;
};

}  // namespace cremed
