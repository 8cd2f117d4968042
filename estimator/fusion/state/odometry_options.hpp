// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/motion/doppler_velocity.hpp"

namespace cremed {

/// A quantity that forgets its value: Ornstein-Uhlenbeck, exp(-t / time) of it is left after t.
struct ForgettingNoise {
  double std = 0.0;     ///< Standard deviation that it has when nothing is known.
  double time_s = 1.0;  ///< After which it is another.
};

/// The priors of the odometry filter. Those that a user may know are keys of [odometry] in
/// the configuration. Defaults: five ARS408 of a car on two real drives (nuScenes 0061, 0103)
/// unless another source is named.
struct OdometryOptions {
  // How a road vehicle moves.
  ForgettingNoise acceleration{1.5, 1.0};      ///< m/s^2, along x.
  ForgettingNoise yaw_acceleration{0.3, 0.5};  ///< rad/s^2.
  /// Angle between the way the vehicle rolls and the x axis of its frame, and how it walks, as
  /// tyres do in a turn: rad, rad/sqrt(s).
  double slip_std_rad = 0.0075;
  double slip_walk = 0.001;
  /// Velocity of the body that carries the radars over that of the wheels' contact: pitch,
  /// suspension; m/s.
  ForgettingNoise body_velocity{0.03, 1.0};
  /// Before the first scan.
  double start_speed_std_mps = 30.0;
  double start_yaw_rate_std_radps = 0.3;

  // Errors of one radar that change slowly.
  double mount_yaw_std_rad = 0.0075;       ///< Of a mount measured by hand.
  double mount_yaw_across_std_rad = 0.02;  ///< And more for one that looks across the way.
  double mount_yaw_walk = 0.0003;          ///< rad/sqrt(s): it is screwed on.
  /// What changes of mount yaw (rad) and Doppler scale from one drive to the next, where they are
  /// taken over: of two drives of one car each (nuScenes) mounts differ by 0.002 rad RMS a drive,
  /// of which one that turns tightly has the most.
  double mount_yaw_restart_std_rad = 0.002;
  double doppler_scale_restart_std = 0.0005;
  double lever_std_m = 0.1;          ///< Of its place, along each axis.
  double doppler_scale_std = 0.002;  ///< Of one, after calibration.
  /// The same of all radars together: what elevation of targets takes from Doppler differs between
  /// drives.
  double common_scale_std = 0.002;
  /// Of one: scale of azimuths, which is one of the velocity across the radar's axis; and what of
  /// such errors changes with doppler_x, of the speed across. Radars that look sideways read 1 to
  /// 3 % too little, with 0.2 to 0.4 m/s RMS at 8 m/s.
  double azimuth_scale_std = 0.02;
  double doppler_x_across_share = 0.03;
  ForgettingNoise doppler_x{0.035, 0.3};  ///< m/s, of the velocity by Doppler, along x.
  ForgettingNoise doppler_y{0.05, 0.3};   ///< m/s, along y,
  double doppler_y_per_yaw_rate_m = 0.1;  ///< and more in turns: m/s for a rad/s.
  ForgettingNoise offset{0.03, 2.0};      ///< m/s, of all Doppler of the radar,
  double offset_per_yaw_rate_m = 0.03;    ///< and more in turns.
  /// And more for radars that look across the way, m/s: an ARS408 tells velocities in steps of
  /// 0.25 m/s, 0.25 / sqrt(12) of which all targets share where the speed along the axis is steady.
  double offset_across_mps = 0.07;
  ForgettingNoise common_offset{0.01, 1.0};  ///< The same of all radars together.
  double common_offset_per_yaw_rate_m = 0.1;
  double yaw_scale_std = 0.02;          ///< Of yaw by positions, of one: azimuths err by so much.
  double common_yaw_scale_std = 0.015;  ///< The same of all radars together.
  ForgettingNoise yaw_per_metre{0.0003, 5.0};    ///< rad/m, of yaw by positions over distance.
  ForgettingNoise lateral_per_metre{0.02, 5.0};  ///< Of y by positions over distance.

  // Doppler.
  /// Of one target: start of what is learned from residuals.
  double doppler_std_mps = kArs408DopplerStdMps;
  double velocity_floor_x_mps = 0.005;  ///< The best that a scan's velocity can be,
  double velocity_floor_y_mps = 0.02;   ///< sideways.
  double max_doppler_nis = 16.0;        ///< Gate, two degrees of freedom: 0.03 % by chance.

  // Positions.
  int keyframe_period = 5;          ///< Every so many scans of a radar is a keyframe.
  int min_lag = 4;                  ///< Scans from keyframe to current: nearer ones are biased.
  int min_targets = 20;             ///< Fewer in a scan: chance neighbours pass for pairs.
  double min_matched_share = 0.35;  ///< Of targets found again.
  double scan_noise_share = 0.45;   ///< Part of a registration's covariance that is each scan's.
  double pair_noise_factor = 3.0;   ///< Rest: factor (start + per_lag * lag) covariance.
  double pair_noise_start = 0.3;
  double pair_noise_per_lag = 0.05;
  double max_position_nis = 18.0;  ///< Gate, two degrees of freedom: 0.01 % by chance.

  // Status.
  double standstill_mps = 0.1;
  /// The start is over once the prior no longer shows: where few targets are seen (tunnel, open
  /// field) yaw rate stays as uncertain as Doppler and mounts leave it, 0.03 to 0.06 rad/s.
  double settled_speed_std_mps = 0.5;
  double settled_yaw_rate_std_radps = 0.1;
  int settled_scans = 5;
  double predicted_s = 0.25;  ///< Two scans of an ARS408 are missing.
  double ambiguous_s = 1.0;   ///< A car beside us may hide the road for 13 scans of an ARS408.
  double lost_s = 1.0;        ///< By then the speed may have changed by several m/s.

  // Time.
  double anchor_period_s = 2.2;  ///< The pose is told relative to an anchor renewed so often.
  double max_lateness_s = 0.2;   ///< A scan older than the latest by more is not used.
  double max_gap_s = 2.0;        ///< Longer without any scan: begins anew.
  /// Outputs between scans, of the state predicted to whole multiples of 1 / rate; anchors are then
  /// renewed at these. 0: none.
  int rate_hz = 0;
};

}  // namespace cremed
