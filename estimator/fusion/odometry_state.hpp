// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/gaussian_state.hpp"
#include "cremed/estimator/fusion/learned_errors.hpp"
#include "cremed/estimator/fusion/odometry_options.hpp"
#include "cremed/estimator/fusion/radar_measurement.hpp"
#include "cremed/estimator/fusion/state_layout.hpp"
#include "cremed/estimator/fusion/vehicle_motion.hpp"
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
  void start();
  /// The motion alone begins anew, with (v, w) and their covariance.
  void start_motion(const Eigen::Vector2d& value, const Eigen::Matrix2d& covariance);
  /// So do the errors of a radar, and what a drive before learned of them counts no longer.
  void start_errors(std::size_t radar);
  /// So does the slip.
  void start_slip();

  /// The vehicle moves on.
  void advance(double dt_s);
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

  [[nodiscard]] MeasurementModel model(std::size_t radar) const;
  [[nodiscard]] int scan(std::size_t radar) const;
  [[nodiscard]] int keyframe(std::size_t radar, std::size_t keyframe) const;
  [[nodiscard]] int error(std::size_t radar, int which) const;

  GaussianState gaussian;

 private:
  void start_passing_errors(std::size_t radar);
  void start_shared(int which, const SharedPrior& prior);

  OdometryOptions options_;
  std::vector<Pose2> mounts_;
  SharedPrior mount_yaw_;
  SharedPrior doppler_scale_;
};

}  // namespace cremed
