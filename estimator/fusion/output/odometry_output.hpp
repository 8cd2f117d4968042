// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// What is published of the state: the pose relative to an anchor and since the start, velocities,
/// and the motion since the last output. All but status and radars left out.
///
/// The anchor is a pose of the recent past that has no error because it is the origin. When it is
/// renewed all poses of the state are expressed in its frame: covariances stay small, and what the
/// state learns of the past never turns the pose since the start.
class OdometryOutput {
 public:
  /// The state must outlive this.
  explicit OdometryOutput(OdometryState& state);

  /// The state has begun anew at its time, in the frame of an anchor there.
  void start();
  /// The same at once after the start, once the speed is known.
  void restart_anchor();
  /// Before a start: the pose since the start stays what was published last; how far the vehicle
  /// went in `gap_s` is unknown, and its covariance says so.
  void bridge(double gap_s);
  /// The clock of the stamps was set.
  void forget_predictions();

  /// Moves the state on, with a new anchor on the way if one is due there.
  void advance_to(std::int64_t stamp_us);
  void add_radar(std::size_t radar) { radars_ |= 1U << radar; }

  /// At the time of the state.
  Odometry next();
  /// See OdometryFilter::predict_next.
  std::optional<Odometry> predict_next(std::int64_t now_us);

 private:
  /// The pose since the start at which poses of the state begin.
  struct Anchor {
    std::int64_t utime_us = 0;
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

    [[nodiscard]] Anchor next(std::int64_t utime_us, const VehicleEstimate& vehicle) const;
  };

  [[nodiscard]] static Odometry odometry(const VehicleEstimate& vehicle, const Anchor& anchor,
                                         std::int64_t utime_us);
  void add_motion(Odometry& odometry);
  [[nodiscard]] Odometry predicted(std::int64_t utime_us) const;
  void renew_anchor();

  OdometryState& state_;
  Anchor anchor_;
  /// Where predictions that were published have the next anchor.
  std::optional<std::int64_t> next_anchor_us_;
  /// The last output, the pose since the start there, and the radars that took part since.
  std::int64_t output_us_ = 0;
  Eigen::Vector3d odom_pose_ = Eigen::Vector3d::Zero();
  std::uint32_t radars_ = 0;
  /// The same of the last prediction.
  std::int64_t predicted_us_ = std::numeric_limits<std::int64_t>::min();
  Eigen::Vector3d predicted_odom_pose_ = Eigen::Vector3d::Zero();
  std::uint32_t radars_since_prediction_ = 0;
};

}  // namespace cremed
