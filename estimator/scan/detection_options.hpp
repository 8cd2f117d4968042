// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace cremed
