// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/odometry.hpp"
#include "cremed/estimator/fusion/odometry_options.hpp"
#include "cremed/estimator/fusion/odometry_state.hpp"
#include "cremed/estimator/fusion/radar_track.hpp"
#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// A radar as the filter is told of it.
struct OdometryRadar {
  Pose2 vehicle_from_radar;
  RegistrationOptions registration;
  std::optional<LearnedErrors> learned = std::nullopt;  ///< In a drive before.
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

  /// With options.rate_hz: the next output due by `now_us`, which the state is predicted to;
  /// nothing if there is none, before the first scan, and once the last is max_gap_s ago.
  /// Predictions are told in order, once each; the next may be earlier than the time of a scan that
  /// comes later.
  std::optional<Odometry> predict_next(std::int64_t now_us);

  /// The clock of the stamps was set: begins anew, but for the pose since the start.
  void forget();

  [[nodiscard]] RadarReport report(std::size_t radar) const;
  /// What a next drive may begin with, by radar: nothing of one that is left out. Allocates.
  [[nodiscard]] std::vector<std::optional<LearnedErrors>> learned() const;
  [[nodiscard]] const GaussianState& state() const { return state_.gaussian; }

 private:
  /// Its pose since the start.
  struct Anchor {
    std::int64_t utime_us = 0;
    Eigen::Vector3d pose = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();

    [[nodiscard]] Anchor next(std::int64_t utime_us, const VehicleEstimate& vehicle) const;
  };
  void bridge(double gap_s);
  void start(std::int64_t stamp_us);
  void anchor_here();
  void advance_to(std::int64_t stamp_us);
  void renew_anchor();
  void believe(std::size_t radar, bool is_believed);
  bool use_doppler(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us);
  bool sees_two_worlds(std::size_t radar, const TargetSet& targets, const ScanVelocity& scan,
                       std::int64_t stamp_us);
  bool take_doppler(std::size_t radar, const ScanVelocity& scan, std::int64_t stamp_us);
  void use_positions(std::size_t radar, const TargetSet& targets, double age_s);
  void use_pair(std::size_t radar, std::size_t keyframe, const RadarTrack::Pair& pair);
  void ask_majority(std::int64_t stamp_us);
  [[nodiscard]] int count_verdicts(std::int64_t stamp_us, bool agree) const;
  void tell(const VehicleEstimate& vehicle, const Anchor& anchor, std::int64_t utime_us,
            Odometry& odometry) const;
  void tell_motion(Odometry& odometry);
  [[nodiscard]] Odometry predicted(std::int64_t utime_us) const;
  [[nodiscard]] OdometryStatus status(const VehicleEstimate& vehicle, std::int64_t utime_us) const;
  [[nodiscard]] bool is_known() const;
  [[nodiscard]] bool is_unknown() const;
  [[nodiscard]] bool is_lost() const;

  OdometryOptions options_;
  OdometryState state_;
  std::vector<std::unique_ptr<RadarTrack>> tracks_;
  bool has_started_ = false;
  bool is_settled_ = false;  // The start is over.
  std::int64_t time_us_ = 0;
  std::int64_t used_us_ = 0;   // Last measurement used.
  std::int64_t clear_us_ = 0;  // Last one with most of its scan's targets behind it.
  std::int64_t doubt_us_ = 0;  // Last scan that showed two worlds.
  int used_scans_ = 0;
  Anchor anchor_;
  std::int64_t output_us_ = 0;
  std::uint32_t radars_ = 0;
  /// The last prediction, and what took part since; the one that is to be the next anchor.
  std::int64_t predicted_us_ = std::numeric_limits<std::int64_t>::min();
  Eigen::Vector3d predicted_odom_pose_ = Eigen::Vector3d::Zero();
  std::uint32_t radars_since_prediction_ = 0;
  std::optional<std::int64_t> next_anchor_us_;
  Eigen::Vector3d odom_pose_ = Eigen::Vector3d::Zero();
};

}  // namespace cremed
