// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

/// The published part of the state: the pose relative to an anchor and since the start, velocities,
/// and the motion since the last output. Does not set Odometry::status and left_out.
///
/// After restart() only advance_to() moves the state in time; at_scan() publishes it there, and
/// predict_next() between scans.
///
/// The anchor is a recent pose that has no error because it is the origin. When it is renewed, all
/// poses of the state are transformed into its frame. Covariances then stay small.
///
/// The pose since the start is composed of the motions between outputs, as they were when they were
/// published, so that it never jumps. The pose at an anchor includes later corrections of the
/// motion since the anchor before. The covariance of the pose since the start is that by anchors as
/// if independent, the effect of errors that last (LastingErrors), and the square of its difference
/// from the pose by anchors.
class OdometryOutput {
 public:
  /// The state must outlive this object.
  explicit OdometryOutput(OdometryState& state);

  /// What is known of the motion in a gap before a restart.
  enum class Gap : std::uint8_t {
    speed,    ///< The speed and yaw rate before it; they change as a vehicle's do.
    nothing,  ///< They may have been wrong.
  };
  /// Restarts the state, with an anchor there. The pose since the start goes on from that of
  /// the state, moved for 5 s at most as the vehicle did before; its covariance grows by the
  /// unknown motion in `gap_s`.
  void restart(std::int64_t time_us, double gap_s, Gap gap);
  /// To be called when the clock of the stamps was set, before a restart at the new time: what was
  /// published at later times of the old clock does not count. Assumes a gap of max_gap_s.
  void leave_clock();

  /// Propagates the state and renews the anchor on the way if it is due.
  void advance_to(std::int64_t stamp_us);
  /// Makes the present pose the anchor, with options().rate_hz that of the next prediction.
  void end_anchor();
  [[nodiscard]] double anchor_age_s() const {
    return seconds_between(anchor_.utime_us, state_.time_us());
  }
  /// The pose since the start may be wrong by this before the anchor.
  void add_error(const Eigen::Vector3d& odom_error) {
    anchor_.covariance += odom_error * odom_error.transpose();
  }
  /// The same along the present direction.
  void add_error_of_way(double way_m) {
    const double yaw_rad = odom_pose_.z();
    add_error({way_m * std::cos(yaw_rad), way_m * std::sin(yaw_rad), 0.0});
  }
  void add_radar(std::size_t radar) { radars_ |= 1U << radar; }

  /// The output at the time of the state, that of the last scan.
  Odometry at_scan();
  /// See OdometryFilter::predict_next.
  std::optional<Odometry> predict_next(std::int64_t now_us);

 private:
  /// The frame of the state's poses: its pose since the start, with covariance.
  struct Anchor {
    std::int64_t utime_us = 0;
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    /// By segments as if they were independent.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    /// Derivatives of the pose by LastingErrors: scale, slip, yaw per metre.
    Eigen::Matrix3d by_lasting = Eigen::Matrix3d::Zero();

    /// With the errors that last.
    [[nodiscard]] Eigen::Matrix3d full_covariance(const LastingErrors& lasting) const;
    /// The anchor at the estimated pose.
    [[nodiscard]] Anchor moved(std::int64_t at_us, const VehicleEstimate& vehicle) const;
  };

  [[nodiscard]] Odometry odometry(const VehicleEstimate& vehicle, const Anchor& anchor,
                                  std::int64_t utime_us) const;
  void renew_anchor();
  void add_motion(Odometry& odometry);
  [[nodiscard]] Odometry predicted(std::int64_t utime_us) const;
  [[nodiscard]] Eigen::Vector3d odom_pose_of(const Eigen::Vector3d& pose) const;
  [[nodiscard]] Eigen::Vector3d predicted_odom_pose(std::int64_t time_us) const;

  OdometryState& state_;
  Anchor anchor_;
  /// Time of the next anchor, if published predictions refer to it already.
  std::optional<std::int64_t> next_anchor_us_;
  bool is_anchor_over_ = false;
  /// Of the last output: time, pose since the start, and radars used since.
  std::int64_t output_us_ = 0;
  Eigen::Vector3d odom_pose_ = Eigen::Vector3d::Zero();
  /// Square of the difference between the pose since the start and that by anchors, in odom.
  Eigen::Matrix3d drift_covariance_ = Eigen::Matrix3d::Zero();
  std::uint32_t radars_ = 0;
  /// Of the last prediction: time, pose since the start, and radars used since.
  std::int64_t predicted_us_ = std::numeric_limits<std::int64_t>::min();
  Eigen::Vector3d predicted_odom_pose_ = Eigen::Vector3d::Zero();
  std::uint32_t radars_since_prediction_ = 0;
};

}  // namespace cremed
