// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/gaussian_state.hpp"
#include "cremed/estimator/fusion/state/learned_errors.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/fusion/state/state_layout.hpp"
#include "cremed/estimator/fusion/state/vehicle_motion.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// The state of the odometry filter and all that changes it but measurements: what is known at the
/// start, how it goes on, clones, and the anchor in whose frame poses are given.
class OdometryState {
 public:
  /// `learned`: in a drive before, by radar; may be shorter.
  OdometryState(const OdometryOptions& options, std::vector<Pose2> mounts,
                const std::vector<std::optional<LearnedErrors>>& learned = {});

  /// Nothing is known but what the options say; the anchor is here.
  void start(std::int64_t time_us = 0);
  /// The motion alone begins anew, with (v, w) and their covariance.
  void start_motion(const Eigen::Vector2d& value, const Eigen::Matrix2d& covariance);
  /// So do the errors of a radar, and what a drive before learned of them counts no longer.
  void start_errors(std::size_t radar);
  /// So does the slip.
  void start_slip();

  /// The vehicle moves on; not if the state is later already.
  void advance_to(std::int64_t time_us);
  [[nodiscard]] VehicleEstimate vehicle() const;
  /// A radar's scans come in order: its errors are those of its last scan's time.
  void advance_errors(std::size_t radar, double dt_s);

  /// Pose at a scan that is older than the state (0: of its time).
  [[nodiscard]] Eigen::Vector3d pose_before(double age_s) const;
  /// Clones it, with the noise of the scan's positions in the axes of the vehicle.
  void clone_scan(std::size_t radar, double age_s, const Eigen::Matrix3d& scan_noise);
  void keep_scan(std::size_t radar, std::size_t keyframe);
  void clone_output();
  /// The pose becomes the anchor: all poses are given in its frame from now on.
  void renew_anchor();

  /// What a next drive may begin with, by radar; empty if there is nothing.
  [[nodiscard]] std::vector<LearnedErrors> learned() const;

  [[nodiscard]] std::int64_t time_us() const { return time_us_; }
  [[nodiscard]] const OdometryOptions& options() const { return options_; }
  [[nodiscard]] const Pose2& mount(std::size_t radar) const { return mounts_[radar]; }
  [[nodiscard]] std::size_t radars() const { return mounts_.size(); }
  // Where it stands in `gaussian`: the clone of a radar's scan, of a keyframe, one of its errors.
  [[nodiscard]] int scan(std::size_t radar) const;
  [[nodiscard]] int keyframe(std::size_t radar, std::size_t keyframe) const;
  [[nodiscard]] int error(std::size_t radar, int which) const;

  GaussianState gaussian;

 private:
  void start_passing_errors(std::size_t radar);
  void start_shared(int which, const SharedPrior& prior);

  OdometryOptions options_;
  std::int64_t time_us_ = 0;
  std::vector<Pose2> mounts_;
  SharedPrior mount_yaw_;
  SharedPrior doppler_scale_;
};

}  // namespace cremed
