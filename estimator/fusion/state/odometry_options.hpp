// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "cremed/can_decoders/vehicle_reading.hpp"
#include "cremed/estimator/cost/doppler_rounding.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"

namespace cremed {

/// Ornstein-Uhlenbeck process: the autocorrelation after a time t is exp(-t / time_s).
struct OrnsteinUhlenbeck {
  double std = 0.0;     ///< Stationary standard deviation.
  double time_s = 1.0;  ///< Correlation time.

  bool operator==(const OrnsteinUhlenbeck&) const = default;
};

/// The Ornstein-Uhlenbeck process of this standard deviation that over short times is a random walk
/// of `walk` per sqrt(s). A plain walk has no bound: the common part of slip and mount yaws, which
/// nothing observes, would leave its prior on a long drive.
inline OrnsteinUhlenbeck bounded_walk(double std, double walk) {
  return {std, walk > 0.0 ? 2.0 * std * std / (walk * walk) : 1e9};
}

/// An error of the state with a prior of mean 0: a constant, or an Ornstein-Uhlenbeck process. Its
/// standard deviation may grow: by `per_yaw_rate` for each rad/s of a turn, by
/// `per_lateral_acceleration` for each m/s^2 across, and for a radar that looks sideways by
/// `per_speed_across` for each m/s, and `if_across`.
struct ErrorProcess {
  double std = 0.0;                                         ///< Of the prior, and stationary.
  double time_s = std::numeric_limits<double>::infinity();  ///< Correlation time.
  double per_yaw_rate = 0.0;
  double per_lateral_acceleration = 0.0;
  double per_speed_across = 0.0;
  double if_across = 0.0;
  double walk = 0.0;          ///< Per sqrt(s), of a constant that walks without bound.
  bool only_driving = false;  ///< Its time stands still with the vehicle.

  bool operator==(const ErrorProcess&) const = default;
};

/// Errors of one signal of the vehicle's bus.
struct VehicleSignalOptions {
  bool is_used = false;
  double delay_s = 0.01;    ///< From the measurement to the stamp of the frame.
  double scale_std = 0.01;  ///< Of the factor on the signal.
  OrnsteinUhlenbeck error;  ///< Added to the signal.

  bool operator==(const VehicleSignalOptions&) const = default;
};

/// Speed and yaw rate of the vehicle's own sensors, if its bus tells them. Source of the errors:
/// wheels and gyro of two cars against their map-based poses (nuScenes 0061, 0103, 1094).
struct VehicleOptions {
  /// m/s. Over 10 s the path errs by 0.1 to 0.3 % in each drive, the scale by 0.3 % between them.
  VehicleSignalOptions speed{false, 0.01, 0.01, {0.05, 1.0}};
  /// rad/s. Over 10 s the yaw errs by 0.07 to 0.13 degrees besides bias and scale.
  VehicleSignalOptions yaw_rate{false, 0.01, 0.01, {0.002, 0.2}};
  double delay_std_s = 0.02;               ///< Of a delay: two periods of a message at 100 Hz.
  double scale_time_s = 3600.0;            ///< Tyres warm up, gyros age.
  double yaw_rate_bias_std_radps = 0.001;  ///< These two cars have half of it.
  double yaw_rate_bias_walk = 0.00001;     ///< rad/s/sqrt(s): 0.03 deg/s an hour.
  /// A wheel's pulses are too rare to tell speeds below kDrivingMps by more than this, m/s.
  double crawling_std_mps = 0.1;
  double period_s = 0.05;  ///< Of measurements: the mean of the readings in it.
  double max_nis = 12.0;   ///< Gate, 1 DoF: false-alarm rate 0.05 %.
  double lost_s = 0.5;     ///< Time after which an ARS408 itself gives up the signal.

  [[nodiscard]] const VehicleSignalOptions& of(VehicleSignal signal) const {
    return signal == VehicleSignal::speed ? speed : yaw_rate;
  }
  [[nodiscard]] bool is_used() const { return speed.is_used || yaw_rate.is_used; }

  bool operator==(const VehicleOptions&) const = default;
};

/// What is left of errors that last for the drive, in the motion from anchor to anchor: RMS of the
/// constant part of each drive of 4 to 10 minutes, simulated by another simulator with errors drawn
/// from the priors (town, country road, motorway, stops; five radars, front and rear, front and
/// rear corners). One segment does not show them; after minutes they are most of the error of the
/// pose since the start.
struct LastingErrors {
  double scale_std = 0.002;            ///< Of the way: 0.06 to 0.21 %.
  double slip_std_rad = 0.004;         ///< And mounts' common yaw: 0.0027 to 0.0045.
  double yaw_per_metre_std = 0.00005;  ///< rad/m: 0.00001 to 0.00008.

  bool operator==(const LastingErrors&) const = default;
};

/// Priors and limits of the odometry filter. Some are keys of [odometry] in the configuration.
/// Source of the defaults, unless stated otherwise: five ARS408 of a car on two real drives
/// (nuScenes 0061, 0103).
struct OdometryOptions {
  // Process noise of a road vehicle.
  OrnsteinUhlenbeck acceleration{1.5, 1.0};  ///< m/s^2, along x.
  /// rad/s^2, of a vehicle that is slow. The driver turns the wheel so that the lateral
  /// acceleration v w changes by no more than `lateral_jerk_std_mps3`: see yaw_acceleration_at().
  OrnsteinUhlenbeck yaw_acceleration{0.3, 0.5};
  /// m/s^3. By the gyros v w' is 0.02 to 0.4 RMS, 1.2 in the tightest turn (1094) and 3 at most
  /// there. With 1 the path errs by a third more on 1094, and with 2 an innocent radar is named in
  /// simulated bends if the learned mounts are wrong.
  double lateral_jerk_std_mps3 = 3.0;
  /// Slip, the angle between the direction of rolling and the x axis (rad), and its random walk by
  /// tyre slip in turns (rad/sqrt(s)).
  double slip_std_rad = 0.0075;
  double slip_walk = 0.001;
  /// Slip of the rear axle to the outside of a turn, per centripetal acceleration v w (rad s^2/m):
  /// v_y = -slip_per_lateral_acceleration v^2 w; and its standard deviation.
  double slip_per_lateral_acceleration = 0.003;
  double slip_per_lateral_acceleration_std = 0.0015;
  /// Velocity of the body over the wheels, m/s: pitch, suspension.
  OrnsteinUhlenbeck body_velocity{0.03, 1.0};
  /// Prior before the first scan.
  double start_speed_std_mps = 30.0;
  double start_yaw_rate_std_radps = 0.3;

  // Slowly varying errors of one radar.
  double mount_yaw_std_rad = 0.005;        ///< Of a mount measured by hand.
  double mount_yaw_across_std_rad = 0.02;  ///< Added for a radar that looks sideways.
  double mount_yaw_walk = 0.0003;          ///< rad/sqrt(s): the mount is rigid.
  /// Change of mount yaw (rad) and Doppler scale between drives, if learned values are taken over.
  /// Between two drives of the same car (nuScenes) mounts differ by 0.002 rad RMS, mostly by a
  /// drive with tight turns.
  double mount_yaw_restart_std_rad = 0.002;
  double doppler_scale_restart_std = 0.0005;
  double lever_std_m = 0.1;          ///< Of the mount's position, along each axis.
  double doppler_scale_std = 0.002;  ///< Of one radar, after calibration.
  /// Correlation time of a radar's Doppler scale. The mean of all radars is hardly observable:
  /// without this it drifted by 0.16 % in 15 minutes of a simulated town.
  double doppler_scale_time_s = 600.0;
  /// Doppler scale common to all radars: the effect of the elevation of targets differs between
  /// drives.
  double common_scale_std = 0.003;
  /// Scale of azimuths of one radar, which scales the velocity across the radar's axis.
  double azimuth_scale_std = 0.02;
  /// m/s: velocity by Doppler along x. Radars that look sideways measure 1 to 3 % too little, with
  /// 0.2 to 0.4 m/s RMS at 8 m/s.
  ErrorProcess doppler_x{.std = 0.035, .time_s = 0.3, .per_speed_across = 0.03};
  /// m/s: along y.
  ErrorProcess doppler_y{.std = 0.08, .time_s = 1.0, .per_yaw_rate = 0.1};
  /// m/s: all Doppler of the radar. An ARS408 quantises velocities to 0.25 m/s; if it looks
  /// sideways all targets share the error of 0.25 / sqrt(12) while the speed along its axis is
  /// constant.
  ErrorProcess offset{.std = 0.03, .time_s = 2.0, .per_yaw_rate = 0.03, .if_across = 0.07};
  /// m/s: of the speed by all radars, while creeping. At 0.25 m/s^2 the next step is a second away.
  ErrorProcess rounding{.std = kRoundingStdMps, .time_s = 1.0};
  /// m/s: of the speed by all radars, where slow cars pass as static: OdometryState::mixture_std().
  ErrorProcess mixture{.std = 0.0, .time_s = 3.0};
  /// Scale of azimuths in positions: of one radar, and common to all. Not estimated: in a turn it
  /// cannot be separated from the turn, and on a straight not from drifting targets.
  double position_azimuth_scale_std = 0.005;
  double common_azimuth_scale_std = 0.005;
  /// Of a scan against the map: yaw error for each metre driven since the map's scans, of one radar
  /// and common to all. Against gyro and truth (0061, 0103, 1094, RadarScenes
  /// 105) yaw scatters by 0.1 to 0.2 degrees, whatever the distance; a third of that variance lasts
  /// for a second, and each radar has a mean of 0.0001 rad/m in a drive, up to 0.0007 for 15 s. The
  /// common part is considered only, since Doppler tells the yaw rate less well. Without it, and
  /// with 0.0004 for one radar, yaw errs by a fifth more.
  ErrorProcess yaw_per_metre{0.0002, 1.5};
  double common_yaw_per_metre_std = 0.0002;
  /// y error for each metre driven since the map's scans. It grows in fast turns, where tyres slip
  /// otherwise than by slip_per_lateral_acceleration. With 0.02 always, the path errs by 0.32 %
  /// instead of 0.30 on nuScenes and by 0.65 instead of 0.61 on RadarScenes 105; with 0.005 on a
  /// straight by 0.28, but a front mount 3 degrees off then puts 3.4 % of the poses of 0061 beyond
  /// 5 sigma before it is named.
  ErrorProcess lateral_per_metre{.std = 0.01, .time_s = 5.0, .per_lateral_acceleration = 0.015};

  LastingErrors lasting;  ///< In the pose since the start.

  // Doppler.
  /// Of one target: initial value, adapted to the residuals.
  double doppler_std_mps = kArs408DopplerStdMps;
  double velocity_floor_x_mps = 0.005;  ///< Added noise of a scan's velocity, forward.
  double velocity_floor_y_mps = 0.02;   ///< Added noise of a scan's velocity, sideways.
  /// Factor on the covariance of a radar that looks sideways, where others do not: it sees passing
  /// vehicles. With 10 in place of 1 the yaw errs by 0.31 degrees in place of 0.37 on scene 0061,
  /// by 0.41 in place of 0.47 on 1094.
  double doppler_noise_factor_across = 10.0;
  double max_doppler_nis = 16.0;  ///< Gate, 2 DoF: false-alarm rate 0.03 %.

  // Positions.
  double static_doppler_mps = 0.5;  ///< A static target's Doppler is expected to within this.
  /// Static ones. On a simulated country road with 5 to 10 in a scan the way of 10 s of five radars
  /// errs by 21 % with 20, since mounts are not learned; by 3.3, 2.0 and 2.0 % with 8, 6 and 4.
  /// With 4 a lone front radar is usable for 66 % of the time, with 6 for 94 %.
  int min_targets = 6;
  double min_matched_share = 0.2;  ///< Least share of matched targets: half are new in a turn.
  /// A map takes a scan after this time if the vehicle moved by node_way_m or turned by
  /// node_turn_rad.
  double node_period_s = 0.25;
  double node_way_m = 0.3;
  double node_turn_rad = 0.02;
  /// Factor on the standard deviations of positions while partners are sought. Positions of the
  /// same target scatter by less than an ARS408 reports (calibrate: azimuths by half).
  double position_std_factor = 0.7;
  /// Factor on the covariance of a scan against the map. A target's noise counts once against that
  /// of twelve earlier scans, not twice: 0.54. Isolated targets scatter by 0.24 to 0.29 degrees in
  /// azimuth from scan to scan where the reported noise with that factor is 0.7: 0.15. From 0.1 to
  /// 0.5 errors change by less than a tenth; NoiseFactor widens it for noise that is all white.
  double position_noise_factor = 0.2;
  /// Factor on the same covariance where all radars look sideways: the reflections of passed
  /// objects move along with the vehicle. Without it up to 24 % of the poses by the right radar of
  /// 0796 are beyond 5 sigma. Where others look ahead or back, positions of such a radar are not
  /// used.
  double position_noise_factor_across = 30.0;
  double position_lateral_floor_m = 0.01;  ///< Added noise of a scan against the map, x and y.
  double position_yaw_floor_rad = 0.0005;  ///< Added noise of yaw.
  double position_yaw_per_turn = 0.01;     ///< Added for each radian turned since the map's scans.
  /// Added noise of x, for each metre driven since the map's scans. With radars that look ahead or
  /// back x scatters by 0.004 to 0.009 from scan to scan and by 0.002 to 0.005 over 2 s, since
  /// scans share the map (nuScenes, RadarScenes 105).
  double position_x_per_metre = 0.045;
  /// Error of x for each metre, common to all radars: chance neighbours pull x to where a radar
  /// sees the same density of targets, which moves along with the vehicle. Times the ratio of the
  /// prior's information of x to that of targets (MapMatch::x_share). x is off by up to 0.7 % on
  /// nuScenes (once 1.5), where that ratio is about 1, by 0.1 to 0.3 % on RadarScenes 105 (0.1),
  /// and by 0.7 to 2 % along simulated hedges (2 to 3): without it the way of 10 s along these errs
  /// by 29 to 101 times its variance, with it by 2 to 4.
  double common_x_per_metre_std = 0.004;
  /// Gate, 2 DoF: false-alarm rate 0.01 %. x hardly counts: its noise is several times its errors.
  double max_position_nis = 18.0;

  // Status.
  double standstill_mps = 0.1;
  /// The start ends below these. With few targets (tunnel, open field) the yaw rate's sigma stays
  /// at 0.03 to 0.06 rad/s, from Doppler and mounts.
  double settled_speed_std_mps = 0.5;
  double settled_yaw_rate_std_radps = 0.1;
  int settled_scans = 5;
  double predicted_s = 0.25;  ///< Two missing scans of an ARS408.
  double ambiguous_s = 1.0;   ///< A car alongside may hide the road for 13 scans of an ARS408.
  double lost_s = 1.0;        ///< The speed may then have changed by several m/s.

  // Time.
  double anchor_period_s = 2.2;  ///< Period of the anchor's renewal.
  double max_lateness_s = 0.2;   ///< Largest age of a scan relative to the latest.
  double max_gap_s = 2.0;        ///< Longer time between scans: restart.
  /// Rate of predictions, at whole multiples of 1 / rate; anchors are then renewed at these times.
  /// 0: none.
  int rate_hz = 0;

  VehicleOptions vehicle;  ///< [vehicle] in the configuration.

  bool operator==(const OdometryOptions&) const = default;
};

}  // namespace cremed
