// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// Conic ray of Gaussians along the sensor's axis (Sola 2007) that explains targets which were not
/// in the previous scan.
struct OutlierRayOptions {
  double weight = 0.5;        ///< w_o: total weight in the mixture, 0 (no ray) .. < 1.
  double min_range_m = 0.5;   ///< r_min
  double max_range_m = 50.0;  ///< r_max
  double ratio = 0.7;         ///< a: standard deviation over range of a component, 0 < a < 1.
  double growth = 1.8;        ///< b: range of a component over that of the one before, > 1.
  double field_of_view_rad = 1.3962634015954636;  ///< Full opening angle; 80 deg.
};

/// How Doppler enters.
struct DopplerOptions {
  bool enabled = true;
  /// Use that of the previous scan too. With CovarianceModel::exclusive only.
  bool both_scans = true;
  /// s_dt: standard deviation of the time between two scans, as each target's own. The paper has
  /// 0.005 s for the ARS408. Measured on nuScenes 0061 and 0103 (54 000 static targets) Doppler
  /// scatters around the best velocity by 0.10 m/s at 3 m/s and by 0.12 m/s at 9 m/s: none.
  double stamp_std_s = 0.0;
  double moving_weight = 0.05;    ///< Weight of the component for moving targets, 0..1.
  double moving_std_mps = 100.0;  ///< Its standard deviation.
};

/// Standard deviations of errors that all targets of a scan share: unlike a target's own, they do
/// not average out, however many targets there are. With CovarianceModel::exclusive only. While the
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

/// What estimate and covariance rest on.
enum class CovarianceModel : std::uint8_t {
  exclusive,     ///< All one-to-one assignments of targets, curvature: see ExclusiveLikelihood.
  gauss_newton,  ///< The paper: Max-Sum-Mixture and (J'J)^-1; over-confident where targets cluster.
};

/// Settings of one registration. Source: shared settings table of the paper (RA-L 2022).
struct RegistrationOptions {
  int degrees_of_freedom = 2;        ///< 2: x and yaw (car-like, y = 0). 3: x, y, yaw.
  double start_scale = 5.0;          ///< Factor on standard deviations in the first stage; 1: none.
  double start_doppler_scale = 2.0;  ///< Further factor on the Doppler ones in the first stage.
  int max_start_iterations = 5;      ///< Gauss-Newton steps of the first stage.
  int max_iterations = 100;          ///< Gauss-Newton steps of the second stage.
  /// The second stage ends at a step shorter than this, squared, in standard deviations (step' J'J
  /// step).
  double step_tolerance = 1e-5;
  /// Where few targets are found again, search from other yaw angles. Of use where the start is a
  /// guess, not where it is a prediction.
  bool restarts = true;
  /// Limit on the work of one registration, in evaluations of a mixture component.
  std::int64_t max_component_evaluations = 800'000;
  CovarianceModel covariance = CovarianceModel::exclusive;
  OutlierRayOptions outlier_ray;
  DopplerOptions doppler;
  SharedErrorOptions shared_errors;
};

}  // namespace cremed
