// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Conic ray of Gaussians along the sensor's axis (Sola 2007) that explains targets which were not
/// in the previous scan.
struct OutlierRayOptions {
  double weight = 0.5;        ///< w_o: total weight in the mixture, 0 (no ray) .. < 1.
  double min_range_m = 0.5;   ///< r_min
  double max_range_m = 50.0;  ///< r_max
  double field_of_view_rad = 1.3962634015954636;  ///< Full opening angle; 80 deg.
};

/// How Doppler enters.
struct DopplerOptions {
  bool enabled = true;
  /// Use that of the previous scan too; false where it has none, as in the paper's simulation. With
  /// Likelihood::exclusive only.
  bool both_scans = true;
  /// s_dt: standard deviation of the time between two scans, as each target's own. The paper has
  /// 0.005 s for the ARS408. Measured on nuScenes 0061 and 0103 (54 000 static targets) Doppler
  /// scatters around the best velocity by 0.10 m/s at 3 m/s and by 0.12 m/s at 9 m/s: none.
  double stamp_std_s = 0.0;
  double moving_weight = 0.05;    ///< Weight of the component for moving targets, 0..1.
  double moving_std_mps = 100.0;  ///< Its standard deviation.
};

/// Slower than this a vehicle's body comes to rest: the systematic errors of one that drives (of
/// Doppler, mount and body) count in proportion to the speed, up to this one.
inline constexpr double kRollingMps = 1.0;

/// Standard deviations of errors that all targets of a scan share: unlike a target's own, they do
/// not average out, however many targets there are. With Likelihood::exclusive only. While the
/// vehicle stands all but the accelerations are zero.
///
/// The defaults are what ARS408 show against wheel encoders on nuScenes 0061 and 0103: the front
/// and rear radars' x differs by 0.022 to 0.046 m/s from the wheels (0.02 m/s of it the wheels'
/// own), where the targets' own noise makes it 0.02 m/s; five radars together still by 0.02 to 0.03
/// m/s. Over a drive their speed is off the wheels' by a factor of 0.0027 RMS, once the 0.005 that
/// all of them lack is put right: doppler_scale. The directions in which radars see the vehicle go
/// differ by 0.009 rad from one another: mount_yaw, of a mount that was measured but not
/// calibrated.
struct SharedErrorOptions {
  double doppler_offset_std_mps = 0.01;      ///< Of all Doppler of one radar.
  double mount_yaw_std_rad = 0.0075;         ///< Of the direction the radar is mounted in.
  double velocity_std_mps = 0.01;            ///< Of the velocity of all radars: pitch, suspension.
  double doppler_scale_std = 0.0027;         ///< Of the factor on all Doppler of one radar.
  double acceleration_std_mps2 = 3.0;        ///< What the vehicle does between two scans,
  double yaw_acceleration_std_radps2 = 0.5;  ///< which the Doppler of both tells.
};

}  // namespace cremed
