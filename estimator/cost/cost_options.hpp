// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/cost/doppler_rounding.hpp"

namespace cremed {

/// Conic ray of Gaussians along the sensor's axis (Sola 2007). It explains targets that were not in
/// the previous scan.
struct OutlierRayOptions {
  double weight = 0.5;        ///< w_o: total weight in the mixture, 0 (no ray) .. < 1.
  double min_range_m = 0.5;   ///< r_min
  double max_range_m = 50.0;  ///< r_max
  double field_of_view_rad = 1.3962634015954636;  ///< Full opening angle; 80 deg.

  bool operator==(const OutlierRayOptions&) const = default;
};

/// How Doppler is used.
struct DopplerOptions {
  bool enabled = true;
  /// Also use the Doppler of the previous scan. false if it has none, as in the paper's simulation.
  /// With Likelihood::exclusive only.
  bool both_scans = true;
  /// s_dt: standard deviation of the time between two scans, independent for each target. The paper
  /// has 0.005 s for the ARS408. The default is 0: on nuScenes 0061 and 0103 (54 000 static
  /// targets) Doppler scatters around the best velocity by 0.10 m/s at 3 m/s and by 0.12 m/s at 9
  /// m/s.
  double stamp_std_s = 0.0;
  double moving_weight = 0.05;    ///< Weight of the component for moving targets, 0..1.
  double moving_std_mps = 100.0;  ///< Its standard deviation.

  bool operator==(const DopplerOptions&) const = default;
};

/// Standard deviations of systematic errors, which all targets of a scan share. They do not average
/// out over the targets. With Likelihood::exclusive only. While the vehicle stands all but the
/// accelerations are zero.
///
/// The defaults were measured with ARS408 against wheel encoders on nuScenes 0061 and 0103. The x
/// velocity of the front and rear radars differs from the wheels by 0.022 to 0.046 m/s, of which
/// the wheels contribute 0.02 m/s and the noise of the targets 0.02 m/s; the mean of five radars
/// still differs by 0.02 to 0.03 m/s. Over a drive, a radar's speed differs from the wheels by a
/// factor of 0.0027 RMS (doppler_scale), after correction of the 0.005 that all radars lack. The
/// directions of travel that the radars measure differ by 0.009 rad from one another (mount_yaw, of
/// a measured but not calibrated mount).
struct SharedErrorOptions {
  double doppler_offset_std_mps = 0.01;  ///< Offset of all Doppler of one radar.
  double mount_yaw_std_rad = 0.0075;     ///< Error of the mounting yaw.
  double velocity_std_mps = 0.01;        ///< Body over wheels: pitch, suspension.
  double doppler_scale_std = 0.0027;     ///< Factor on all Doppler of one radar.
  /// Accelerations of the vehicle between two scans, which the Doppler of both scans observes.
  double acceleration_std_mps2 = 3.0;
  double yaw_acceleration_std_radps2 = 0.5;
  double rounding_std_mps = kRoundingStdMps;  ///< Of the speed, while creeping.

  bool operator==(const SharedErrorOptions&) const = default;
};

}  // namespace cremed
