// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>

namespace cremed {

/// Validity of an Odometry. The numbers are those of odometry_t and never change meaning.
enum class OdometryStatus : std::uint8_t {
  ok = 0,              ///< None of the following.
  standing_still = 1,  ///< ok; speed <= standstill_mps and its sigma too, |yaw rate| <= 3 sigma.
  initialising = 2,    ///< Not yet known since the start: sigma of speed or yaw rate > settled_*;
                       ///< or fewer than settled_scans scans used; or more of the last scans were
                       ///< in doubt (two worlds) than were used; or at rest within 5 s of such a
                       ///< scan; or the radars are not compared yet, for half a second.
  predicted = 3,       ///< No measurement used for > predicted_s.
  ambiguous = 4,       ///< No scan with mostly static targets for > ambiguous_s; or at the start a
                       ///< radar contradicts; or two worlds at the start, parked or predicted.
  lost = 5,            ///< No measurement used for > lost_s; the next restarts the velocity.
};

inline constexpr std::size_t kOdometryStatusCount = 6;

/// The name of a status as in the CSV, e.g. "ok".
std::string_view to_string(OdometryStatus status);

/// Pose and motion of the vehicle at `utime_us`, the time of a scan or of a prediction. Poses are
/// (x_m, y_m, yaw_rad) of the vehicle frame (rear axle), covariances in the same order.
struct Odometry {
  std::int64_t utime_us = 0;
  OdometryStatus status = OdometryStatus::initialising;
  bool is_new = false;  ///< utime_us is later than that of the previous output.

  /// Pose in the frame of the anchor, the pose at utime_anchor_us. Covariances may be chained from
  /// anchor to anchor as if independent, for a minute.
  std::int64_t utime_anchor_us = 0;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

  /// Pose since the start: the composition of the motions below, so that it never jumps. Its
  /// covariance is chained over the anchors, with LastingErrors.
  Eigen::Vector3d odom_pose = Eigen::Vector3d::Zero();
  Eigen::Matrix3d odom_covariance = Eigen::Matrix3d::Zero();

  /// (m/s along x, m/s along y, rad/s)
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
  Eigen::Matrix3d twist_covariance = Eigen::Matrix3d::Zero();

  /// Motion since the previous output, at utime_before_us: pose in its frame. Not set in a
  /// prediction; utime_before_us is then that of the previous prediction.
  std::int64_t utime_before_us = 0;
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  Eigen::Matrix3d motion_covariance = Eigen::Matrix3d::Zero();

  std::uint32_t radars = 0;    ///< Bit i: radar i was used since the previous output.
  std::uint32_t left_out = 0;  ///< Bit i: radar i is not believed (`doubt/`).

  [[nodiscard]] bool is_usable() const {
    return status == OdometryStatus::ok || status == OdometryStatus::standing_still;
  }
};

/// A systematic error that explains the velocities of a radar.
enum class FaultKind : std::uint8_t {
  unknown,      ///< None of these, or several.
  scale,        ///< Doppler too large or small.
  sign,         ///< Doppler of the wrong sign, or a mount turned back to front.
  upside_down,  ///< Left and right exchanged.
  mount_yaw,    ///< It looks in another direction.
  mount_x,      ///< It is further ahead or back.
  late,         ///< Its scans have later stamps than they were measured at.
  exchanged,    ///< Its data are those of a radar at another radar's mount.
  offset,       ///< An error that is the same in all Doppler.
};

struct FaultCause {
  FaultKind kind = FaultKind::unknown;
  /// What corrects it: factor on Doppler (scale), to be added to the mount's yaw in rad
  /// (mount_yaw) or x in m (mount_x), or to the velocity in the direction of view in m/s (offset);
  /// delay in s (late).
  double value = 0.0;
  std::size_t other = 0;  ///< The other radar, if exchanged.
};

/// Targets of one radar since the start, in scans that were registered with its map.
struct MapCounters {
  std::uint64_t at_rest = 0;  ///< By their Doppler: compared with the map.
  std::uint64_t found = 0;    ///< Of these, in the map: sum of probabilities, rounded.
  std::uint64_t moving = 0;   ///< The others: left out.
};

/// Diagnostics of one radar.
struct RadarReport {
  bool is_left_out = false;  ///< It is not believed (`doubt/`).
  FaultCause cause;  ///< If it is left out, or the odometry has learned its mount (TurnedMounts).
  /// Time-averaged NIS per degree of freedom of the last minute: 1 if covariances are true; 0
  /// without measurements.
  double doppler_nis = 0.0;
  double lateral_nis = 0.0;
  double yaw_nis = 0.0;
  /// Factors on the covariances of its measurements (NoiseFactor).
  double doppler_noise_factor = 1.0;
  double position_noise_factor = 1.0;
  /// Learned errors of mount yaw and Doppler scale, with standard deviations.
  double mount_yaw_rad = 0.0;
  double mount_yaw_std_rad = 0.0;
  double doppler_scale = 0.0;
  double doppler_scale_std = 0.0;
  MapCounters targets = {};
};

/// An error of a signal of the vehicle's bus that the radars show.
enum class SignalFault : std::uint8_t { none, offset, scale, delay };

/// Diagnostics of a signal of the vehicle's bus.
struct VehicleSignalReport {
  bool is_used = false;      ///< It is configured; otherwise all is 0.
  bool is_lost = false;      ///< No valid frame for VehicleOptions::lost_s.
  bool is_frozen = false;    ///< It repeats one value while the filter's changes.
  bool is_left_out = false;  ///< It contradicts the filter or the radars.
  int times_lost = 0;        ///< How often each of these began.
  int times_frozen = 0;
  int times_left_out = 0;
  std::uint64_t readings = 0;           ///< Valid frames.
  std::uint64_t measurements_used = 0;  ///< By the filter, each the mean of several readings.
  double nis = 0.0;                     ///< Time-averaged, per degree of freedom, as of a radar.
  /// Learned errors, with standard deviations.
  double scale = 0.0;
  double scale_std = 0.0;
  double bias_radps = 0.0;  ///< Of the yaw rate.
  double bias_std_radps = 0.0;
  /// Which error is a fault (SignalCheck), and the errors.
  SignalFault fault = SignalFault::none;
  double seen_offset = 0.0;   ///< m/s or rad/s
  double seen_scale = 0.0;    ///< Share of the reading: 1 - (true value) / reading.
  double seen_delay_s = 0.0;  ///< Beyond the configured one.
};

}  // namespace cremed
