// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/fusion/tune.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"

namespace cremed {

/// Ornstein-Uhlenbeck process: the autocorrelation after a time t is exp(-t / time_s).
struct OrnsteinUhlenbeck {
  double std = 0.0;     ///< Stationary standard deviation.
  double time_s = 1.0;  ///< Correlation time.
};

/// Priors and limits of the odometry filter. Some are keys of [odometry] in the configuration.
/// Source of the defaults, unless stated otherwise: five ARS408 of a car on two real drives
/// (nuScenes 0061, 0103).
struct OdometryOptions {
  // Process noise of a road vehicle.
  OrnsteinUhlenbeck acceleration{tune("acc",1.5),tune("acct",1.0)};      ///< m/s^2, along x.
  OrnsteinUhlenbeck yaw_acceleration{tune("yacc",0.3),tune("yacct",0.5)};  ///< rad/s^2.
  /// Slip, the angle between the direction of rolling and the x axis (rad), and its random walk by
  /// tyre slip in turns (rad/sqrt(s)).
  double slip_std_rad = tune("slip", 0.0075);
  double slip_walk = tune("slipw", 0.001);
  /// Slip of the rear axle to the outside of a turn, per centripetal acceleration v w (rad s^2/m):
  /// v_y = -slip_per_lateral_acceleration v^2 w; and its standard deviation.
  double slip_per_lateral_acceleration = tune("slipk", 0.003);
  double slip_per_lateral_acceleration_std = tune("slipkstd", 0.0015);
  /// Velocity of the body over the wheels, m/s: pitch, suspension.
  OrnsteinUhlenbeck body_velocity{tune("body",0.03),tune("bodyt",1.0)};
  /// Prior before the first scan.
  double start_speed_std_mps = 30.0;
  double start_yaw_rate_std_radps = 0.3;

  // Slowly varying errors of one radar.
  double mount_yaw_std_rad = tune("mys", 0.0075);       ///< Of a mount measured by hand.
  double mount_yaw_across_std_rad = tune("mya", 0.02);  ///< Added for a radar that looks sideways.
  double mount_yaw_walk = tune("myw", 0.0003);          ///< rad/sqrt(s): the mount is rigid.
  /// Change of mount yaw (rad) and Doppler scale between drives, if learned values are taken over.
  /// Between two drives of the same car (nuScenes) mounts differ by 0.002 rad RMS, mostly by a
  /// drive with tight turns.
  double mount_yaw_restart_std_rad = 0.002;
  double doppler_scale_restart_std = 0.0005;
  double lever_std_m = tune("lever", 0.1);          ///< Of the mount's position, along each axis.
  double doppler_scale_std = tune("dss", 0.002);  ///< Of one radar, after calibration.
  /// Correlation time of that. What radars err by in common is hardly observable: without it their
  /// mean drifted by 0.16 % in 15 minutes of a simulated town.
  double doppler_scale_time_s = 600.0;
  /// Common to all radars: the effect of the elevation of targets on Doppler differs between
  /// drives.
  double common_scale_std = tune("css", 0.002);
  /// Scale of azimuths of one radar, which scales the velocity across the radar's axis; and the
  /// part of the speed across that is added to doppler_x. Radars that look sideways measure 1 to 3
  /// % too little, with 0.2 to 0.4 m/s RMS at 8 m/s.
  double azimuth_scale_std = 0.02;
  double doppler_x_across_share = tune("dxa", 0.03);
  OrnsteinUhlenbeck doppler_x{tune("dx",0.035),tune("dxt",0.3)};  ///< m/s: velocity by Doppler along x,
  OrnsteinUhlenbeck doppler_y{tune("dy",0.05),tune("dyt",0.3)};   ///< m/s: along y,
  double doppler_y_per_yaw_rate_m = tune("dypw", 0.1);    ///< and added to it for each rad/s.
  OrnsteinUhlenbeck offset{tune("off",0.03),tune("offt",2.0)};      ///< m/s: all Doppler of the radar,
  double offset_per_yaw_rate_m = tune("opw", 0.03);      ///< and added to it for each rad/s.
  /// Added for radars that look sideways, m/s: an ARS408 quantises velocities to 0.25 m/s, and all
  /// targets share the error of 0.25 / sqrt(12) while the speed along its axis is constant.
  double offset_across_mps = tune("offa", 0.07);
  OrnsteinUhlenbeck common_offset{tune("coff",0.01),tune("cofft",1.0)};  ///< Common to all radars.
  double common_offset_per_yaw_rate_m = tune("copw", 0.1);
  double positions_azimuth_scale_std = tune("ascale", 0.005);  ///< Of yaw by positions: azimuth errors.
  double common_azimuth_scale_std = tune("cascale", 0.005);        ///< Common to all radars.
  OrnsteinUhlenbeck yaw_per_metre{tune("ypm", 0.0003), tune("ypmt",5.0)};    ///< rad/m: yaw by positions, over distance.
  OrnsteinUhlenbeck lateral_per_metre{tune("lpm",0.02), tune("lpmt",5.0)};  ///< y by positions, over distance.

  // Doppler.
  /// Of one target: initial value, adapted to the residuals.
  double doppler_std_mps = kArs408DopplerStdMps;
  double velocity_floor_x_mps = tune("vfx", 0.005);  ///< Added noise of a scan's velocity,
  double velocity_floor_y_mps = tune("vfy", 0.02);   ///< sideways.
  double max_doppler_nis = 16.0;        ///< Gate, 2 DoF: false-alarm rate 0.03 %.

  // Positions.
  double node_period_s = tune("node", 0.4);
  int min_targets = 20;             ///< With fewer, chance neighbours match.
  double min_matched_share = tune("minmatch", 0.35);  ///< Least share of matched targets.
  double position_noise_factor = tune("pnf", 2.0);
  double position_lateral_floor_m = tune("latfloor", 0.01);
  double position_yaw_floor_rad = tune("yawfloor", 0.0005);
  double position_yaw_per_turn = tune("turnnoise", 0.006);
  double max_position_nis = 18.0;  ///< Gate, 2 DoF: false-alarm rate 0.01 %.

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
};

}  // namespace cremed
