// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/doubt/vehicle/fault_hypotheses.hpp"
#include "cremed/estimator/doubt/vehicle/filter_condition.hpp"
#include "cremed/estimator/doubt/vehicle/radar_consensus.hpp"
#include "cremed/estimator/fusion/majority_follower.hpp"
#include "cremed/estimator/fusion/measurement/radar_track.hpp"
#include "cremed/estimator/fusion/measurement/side_slip.hpp"
#include "cremed/estimator/fusion/output/odometry_output.hpp"
#include "cremed/estimator/fusion/position_fusion.hpp"
#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "cremed/estimator/fusion/traffic_doubt.hpp"
#include "cremed/estimator/fusion/turned_mounts.hpp"
#include "cremed/estimator/fusion/vehicle_signals.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Extended Kalman filter of the vehicle's state from the scans of all its radars.
///
/// `state/`: pose and velocity of the vehicle, propagated by MotionStep; slowly varying errors of
/// each radar; and clones of the pose (Roumeliotis and Burdick, "Stochastic cloning", ICRA 2002) at
/// the nodes of the maps and at the last output.
///
/// `map/`: the static targets of each radar's scans of the last seconds, and the registration of a
/// scan against all of them.
///
/// `measurement/`: a scan gives one measurement of velocity by Doppler (DopplerMeasurement) and one
/// of the motion since the nodes by positions (MapMeasurement).
///
/// `doubt/`: a radar that contradicts the others or itself is left out for some time
/// (FaultHypotheses). A measurement that fails its chi-square gate is not used; if a majority of
/// radars contradicts the filter and agrees with each other, the velocity is reset to theirs
/// (RadarConsensus). A vehicle that stood is not moved by what departs beside it (ParkedVehicle).
///
/// `output/`: poses relative to an anchor and since the start, and predictions between scans.
///
/// `VehicleSignals`: speed and yaw rate of the vehicle's bus, if the options use them.
///
/// A scan may be older than the state; it is then used as a measurement of the state at its time.
/// Work is bounded, and nothing allocates after construction.
class OdometryFilter {
 public:
  /// `mounts`: vehicle from radar. `learned`: in a previous drive, by radar; may be shorter.
  OdometryFilter(const OdometryOptions& options, std::vector<Pose2> mounts,
                 const std::vector<std::optional<LearnedErrors>>& learned = {});
  OdometryFilter(const OdometryFilter&) = delete;
  OdometryFilter& operator=(const OdometryFilter&) = delete;

  /// Updates with the usable targets of a scan. Returns the odometry at the latest stamp so far. A
  /// radar that is not trusted (SelfCheck) is compared with the filter, but not used.
  Odometry update(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us,
                  bool is_trusted = true);

  /// Factor by which the Doppler of all radars must be multiplied from now on, because they share
  /// an error of scale; 1 if none was learned since the last call. The state expects it to be
  /// applied: to be called after each update().
  double take_doppler_factor() { return std::exchange(new_doppler_factor_, 1.0); }

  /// A value of the vehicle's bus, to be used at the next scan. In the order of the stamps.
  void add(const VehicleReading& reading) { vehicle_.add(reading); }

  /// Notes which signals of the vehicle's bus are lost while no scan comes.
  void note_lost_signals(std::int64_t stamp_us) { vehicle_.note_lost(stamp_us); }

  /// A radar's own motion, which is compared with other radars and with the signals of the
  /// vehicle's bus. To be called before update() with its scan.
  /// `is_speed_undecided`: its own check has not decided about its speed yet.
  void compare(std::size_t radar, const EgoMotion& motion, bool is_trusted,
               bool is_speed_undecided = false);

  /// See FaultHypotheses.
  bool refutes_speed_doubt(std::size_t radar, std::int64_t stamp_us, std::optional<double> factor) {
    return faults_.refutes_speed_doubt(radar, stamp_us, factor);
  }

  /// With options.rate_hz: the next prediction due by `now_us`. None if none is due, before the
  /// first scan, or more than max_gap_s after the last. Each prediction is returned once, in order;
  /// it may be later than a scan that arrives after it.
  std::optional<Odometry> predict_next(std::int64_t now_us);

  /// To be called when the clock of the stamps was set: restarts all but the pose since the start.
  void forget();

  /// A parked vehicle starts, or something departs beside it: meanwhile scans are no evidence for
  /// or against a radar.
  [[nodiscard]] bool is_start_in_doubt() const { return traffic_.parked.is_in_doubt(); }
  /// Radars contradict each other, or their own positions, and it is not known which are wrong.
  [[nodiscard]] bool is_fault_unknown() const { return faults_.is_unknown(); }
  [[nodiscard]] RadarReport report(std::size_t radar) const;
  [[nodiscard]] VehicleSignalReport report(VehicleSignal signal) const {
    return vehicle_.report(signal);
  }
  /// Learned errors for the next drive, by radar; none for a radar that is left out. Allocates.
  [[nodiscard]] std::vector<std::optional<LearnedErrors>> learned() const;
  [[nodiscard]] const GaussianState& state() const { return state_.gaussian; }

 private:
  void start_if_needed(std::int64_t stamp_us, bool is_trusted);
  void restart(std::int64_t stamp_us, OdometryOutput::Gap gap);
  [[nodiscard]] bool is_usable(std::size_t radar, const TargetSet& targets,
                               std::int64_t stamp_us) const;
  void set_trusted(std::size_t radar, bool is_trusted);
  [[nodiscard]] bool is_mount_judged(std::size_t radar) const;
  [[nodiscard]] bool is_sideways(std::size_t radar) const;
  bool learn_common_turn();
  bool learn_common_scale();
  bool learn_mount_if_turned(std::size_t radar);
  void allow_for_scale(double scale);
  void reject_jump(std::size_t radar, const SpeedJump::Jump& jump);
  void add_error_of_motion(const Eigen::Vector3d& believed);
  void follow_if_far(const Eigen::Vector3d& believed, double possible_change_mps);
  [[nodiscard]] RadarSet left_out() const;
  bool use_doppler(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us);
  bool take_doppler(std::size_t radar, const TargetSet& targets, const ScanVelocity& scan,
                    std::int64_t stamp_us);
  [[nodiscard]] bool may_be_jolt(std::size_t radar, std::int64_t stamp_us, double change_mps,
                                 const Innovation& innovation) const;
  [[nodiscard]] bool is_only_one_ahead(std::size_t radar, std::int64_t stamp_us) const;
  void answer_contradiction(std::size_t radar, std::int64_t stamp_us, double change_mps,
                            const Innovation& innovation);
  [[nodiscard]] double possible_speed_change_mps(std::int64_t stamp_us) const;
  [[nodiscard]] FaultCause cause(std::size_t radar) const;
  [[nodiscard]] Odometry with_condition(Odometry odometry) const;

  OdometryState state_;
  std::vector<std::unique_ptr<RadarTrack>> tracks_;
  RadarConsensus consensus_;
  FaultHypotheses faults_;
  FilterCondition condition_;
  TrafficDoubt traffic_;
  SideSlip side_slip_;
  TurnedMounts turned_mounts_;
  MajorityFollower majority_;
  PositionFusion positions_;
  OdometryOutput output_;
  VehicleSignals vehicle_;
  double doppler_factor_ = 1.0;  // Learned in all.
  double new_doppler_factor_ = 1.0;
  bool has_started_ = false;
  bool was_ok_ = false;  // Since the start.
};

}  // namespace cremed
