// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimator/fusion/odometry.hpp"
#include "estimator/fusion/odometry_options.hpp"
#include "estimator/fusion/odometry_state.hpp"
#include "estimator/fusion/radar_track.hpp"
#include "estimator/pose2.hpp"
#include "estimator/registration_options.hpp"
#include "estimator/target_set.hpp"

namespace cremed {

/// A radar as the filter is told of it.
struct OdometryRadar {
  Pose2 vehicle_from_radar;
  RegistrationOptions registration;
};

/// One state of the vehicle from the scans of all its radars: an extended Kalman filter.
///
/// State (state_layout): pose and velocity of the vehicle (VehicleMotion), errors of each radar
/// that change slowly, and clones of the pose (Roumeliotis and Burdick, "Stochastic cloning", ICRA
/// 2002): at a few keyframes of each radar, at its current scan and at the last output. Of a scan
/// come one measurement of velocity by its Doppler and up to kKeyframes of the motion since a
/// keyframe by positions (MeasurementModel). A clone of a scan carries the noise of that scan's
/// positions as a part of its pose, so that it counts once in however many pairs the scan takes
/// part.
///
/// Everything is told relative to the anchor, a pose of the recent past that is known without error
/// because it is the origin. When it is renewed all poses are expressed in its frame; covariances
/// stay small, and what the state says of the past never turns the pose since the start.
///
/// Nothing is used unchecked: a measurement whose innovation no covariance explains is not used; a
/// radar that does so in scan after scan is left out until it agrees again; if most radars
/// contradict the filter and agree with each other, it is the filter that is wrong, and its
/// velocity begins anew with theirs.
///
/// A scan may be older than one that came before it: it is then used as a measurement of what the
/// state says of that time. Work is bounded, and nothing allocates after construction.
class OdometryFilter {
 public:
  OdometryFilter(const OdometryOptions& options, std::span<const OdometryRadar> radars);
  OdometryFilter(const OdometryFilter&) = delete;
  OdometryFilter& operator=(const OdometryFilter&) = delete;

  /// Takes the usable targets of a scan; where the vehicle is at the latest stamp so far. A radar
  /// that is not believed (SelfCheck) is compared with the others, but not used.
  Odometry update(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us,
                  bool is_believed = true);

  /// The clock of the stamps was set: begins anew, but for the pose since the start.
  void forget();

  [[nodiscard]] RadarReport report(std::size_t radar) const;
  [[nodiscard]] const GaussianState& state() const { return state_.gaussian; }

 private:
  void bridge(double gap_s);
  void start(std::int64_t stamp_us);
  void anchor_here();
  void believe(std::size_t radar, bool is_believed);
  bool use_doppler(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us);
  bool take_doppler(std::size_t radar, const ScanVelocity& scan, std::int64_t stamp_us);
  void use_positions(std::size_t radar, const TargetSet& targets, double age_s);
  void use_pair(std::size_t radar, std::size_t keyframe, const RadarTrack::Pair& pair);
  void ask_majority(std::int64_t stamp_us);
  [[nodiscard]] int count_verdicts(std::int64_t stamp_us, bool agree) const;
  void tell(Odometry& odometry);
  void tell_motion(Odometry& odometry);
  [[nodiscard]] OdometryStatus status() const;
  [[nodiscard]] bool is_known() const;
  [[nodiscard]] bool is_lost() const;

  OdometryOptions options_;
  OdometryState state_;
  std::vector<std::unique_ptr<RadarTrack>> tracks_;
  bool has_started_ = false;
  bool is_settled_ = false;  // The start is over.
  std::int64_t time_us_ = 0;
  std::int64_t used_us_ = 0;   // Last measurement used.
  std::int64_t clear_us_ = 0;  // Last one with most of its scan's targets behind it.
  int used_scans_ = 0;
  std::int64_t anchor_us_ = 0;
  std::int64_t output_us_ = 0;
  std::uint32_t radars_ = 0;
  Eigen::Vector3d odom_pose_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d odom_covariance_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d anchor_pose_ = Eigen::Vector3d::Zero();  // Since the start.
};

}  // namespace cremed
