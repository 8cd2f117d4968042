// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/gate/filter_condition.hpp"
#include "cremed/estimator/fusion/gate/radar_consensus.hpp"
#include "cremed/estimator/fusion/measurement/radar_track.hpp"
#include "cremed/estimator/fusion/output/odometry_output.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/motion/two_worlds.hpp"
#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// One radar of the vehicle.
struct OdometryRadar {
  Pose2 vehicle_from_radar;
  RegistrationOptions registration;
  std::optional<LearnedErrors> learned = std::nullopt;  ///< In an earlier drive.
};

/// One state of the vehicle from the scans of all its radars: an extended Kalman filter.
///
/// `state/`: pose and velocity of the vehicle, which move on as VehicleMotion says, errors of each
/// radar that change slowly, and clones of the pose (Roumeliotis and Burdick, "Stochastic cloning",
/// ICRA 2002): at a few keyframes of each radar, at its current scan and at the last output.
///
/// `measurement/`: a scan gives one measurement of velocity by its Doppler (DopplerMeasurement) and
/// up to kKeyframes of the motion since a keyframe by positions (PositionMeasurement). A clone of a
/// scan carries the noise of that scan's positions as a part of its pose, so that this noise counts
/// once in however many pairs the scan takes part.
///
/// `gate/`: a measurement whose innovation fails its chi-square gate is not used. A radar whose
/// scans go on failing it is left out until it agrees again. If most radars contradict the filter
/// and agree with each other, the velocity begins anew with theirs.
///
/// `output/`: poses relative to an anchor and since the start, and predictions between scans.
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
  /// Predictions come in order, once each; the next may be earlier than the time of a scan that
  /// comes later.
  std::optional<Odometry> predict_next(std::int64_t now_us);

  /// The clock of the stamps was set: begins anew, but for the pose since the start.
  void forget();

  [[nodiscard]] RadarReport report(std::size_t radar) const;
  /// What a next drive may begin with, by radar: nothing of one that is left out. Allocates.
  [[nodiscard]] std::vector<std::optional<LearnedErrors>> learned() const;
  [[nodiscard]] const GaussianState& state() const { return state_.gaussian; }

 private:
  void begin_if_needed(std::int64_t stamp_us, bool is_believed);
  void start(std::int64_t stamp_us);
  [[nodiscard]] bool is_usable(std::size_t radar, const TargetSet& targets,
                               std::int64_t stamp_us) const;
  void believe(std::size_t radar, bool is_believed);
  bool use_doppler(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us);
  [[nodiscard]] std::optional<Eigen::Vector2d> expected_velocity(std::size_t radar) const;
  bool sees_two_worlds(std::size_t radar, const TargetSet& targets, const ScanVelocity& scan,
                       std::int64_t stamp_us);
  bool take_doppler(std::size_t radar, const ScanVelocity& scan, std::int64_t stamp_us);
  void follow_majority(std::int64_t stamp_us);
  void use_positions(std::size_t radar, const TargetSet& targets, double age_s);
  void use_pair(std::size_t radar, std::size_t keyframe, const RadarTrack::Pair& pair);
  [[nodiscard]] Odometry with_condition(Odometry odometry) const;

  OdometryState state_;
  std::vector<std::unique_ptr<RadarTrack>> tracks_;
  std::vector<TwoWorlds> two_worlds_;
  RadarConsensus consensus_;
  FilterCondition condition_;
  OdometryOutput output_;
  bool has_started_ = false;
};

}  // namespace cremed
