// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/error_table.hpp"
#include "cremed/estimator/fusion/state/gaussian_state.hpp"
#include "cremed/estimator/fusion/state/learned_errors.hpp"
#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "cremed/estimator/fusion/state/state_layout.hpp"
#include "cremed/estimator/fusion/state/vehicle_motion.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// The state of the odometry filter, and everything that changes it except measurements: priors,
/// propagation, clones, and the anchor in whose frame poses are given.
class OdometryState {
 public:
  /// `learned`: of a previous drive, by radar; may be shorter.
  OdometryState(const OdometryOptions& options, std::vector<Pose2> mounts,
                const std::vector<std::optional<LearnedErrors>>& learned = {});

  /// Resets the state to its prior, with the anchor at its pose.
  void start();
  /// As start(), but keeps what has been learned of slip and radars.
  void restart(std::int64_t time_us);
  /// Resets speed and yaw rate to `value` (v, w) with `covariance`, and the accelerations to their
  /// prior.
  void start_motion(const Eigen::Vector2d& value, const Eigen::Matrix2d& covariance);
  /// Widens the errors of a radar to the variance of their prior, around the present estimate.
  void widen_errors(std::size_t radar);
  /// The Doppler scale of a radar may be off by `std`.
  void widen_scale(std::size_t radar, double std);
  /// The Doppler of all radars had an error of scale that shifted the speed by `error_mps`: begins
  /// motion, scale and passing errors anew.
  void start_scale(double error_mps);
  /// The mount of a radar turned: its yaw error is `yaw_rad` with `std_rad`, and the slip unknown.
  /// From then on the error is taken to stay as it is, not to pass.
  void turn_mount(std::size_t radar, double yaw_rad, double std_rad);
  /// Its yaw error is that of a mount measured by hand again.
  void turn_mount_back(std::size_t radar);
  /// Whether it is turned: with others, or by more than a mount measured by hand may be off.
  [[nodiscard]] bool is_turned(std::size_t radar) const { return is_turned_[radar]; }
  /// Its error of yaw, if its mount turned; 0 otherwise.
  [[nodiscard]] double turned_rad(std::size_t radar) const {
    return is_turned(radar) ? gaussian.mean(error(radar, state_layout::kMountYaw)) : 0.0;
  }
  /// Several mounts turned, all by this angle and its standard deviation; the slip is unknown, and
  /// the errors of their Doppler, which followed the turn.
  void turn_mounts(RadarSet radars, double by_rad, double std_rad);

  /// Propagates the vehicle to `time_us`, if that is later.
  void advance_to(std::int64_t time_us);
  [[nodiscard]] VehicleEstimate vehicle() const;
  /// Propagates a radar's errors, which refer to the time of its last scan.
  void advance_errors(std::size_t radar, double dt_s);
  /// Takes a scan's DopplerExcess, by which slow cars among the static targets show.
  void add_excess(double excess_m2ps2);
  /// Standard deviation (m/s) of the shift of all radars' speed by such cars.
  [[nodiscard]] double mixture_std() const;
  /// The vehicle may have begun to brake or accelerate as hard as its tyres hold, `since_s` ago.
  void add_jolt(double since_s);
  /// The vehicle skids with a slip of this size (rad) that was not expected (SideSlip): for seconds
  /// its slip is that uncertain.
  void add_skid(double slip_rad);
  /// Of the slip, beyond that of usual driving (rad^2).
  [[nodiscard]] double skid_variance() const;
  /// Infinite if there was none.
  [[nodiscard]] double since_skid_s() const { return since_skid_s_; }

  /// Resets the errors of a signal of the vehicle's bus to their prior.
  void start_signal(VehicleSignal signal);
  /// Propagates the errors of a signal.
  void advance_signal(VehicleSignal signal, double dt_s);

  /// Kalman update with an innovation of `gaussian`, which does not change the mean of errors that
  /// are considered only (StateError::considered_by).
  void update(const Innovation& innovation, bool is_of_positions = false);

  struct PastPose {
    Eigen::Vector3d pose;
    Eigen::Matrix<double, state_layout::kPose, state_layout::kMotionStates> by_motion;
  };
  /// Pose at a scan that is `age_s` older than the state, and its derivative by the motion states.
  [[nodiscard]] PastPose pose_before(double age_s) const;
  /// Clones the pose at a scan that is `age_s` older than the state as a node.
  void clone_node(std::size_t node, double age_s);
  [[nodiscard]] Eigen::Vector3d node_pose(std::size_t node) const;
  void clone_output();
  /// Makes the pose the anchor and transforms all poses into its frame.
  void renew_anchor();

  /// Learned errors for the next drive, by radar; empty if there are none.
  [[nodiscard]] std::vector<LearnedErrors> learned() const;

  [[nodiscard]] std::int64_t time_us() const { return time_us_; }
  [[nodiscard]] const OdometryOptions& options() const { return options_; }
  [[nodiscard]] const Pose2& mount(std::size_t radar) const { return mounts_[radar]; }
  [[nodiscard]] std::span<const Pose2> mounts() const { return mounts_; }
  [[nodiscard]] std::size_t radars() const { return mounts_.size(); }
  /// Radars that look ahead or back; the others look sideways (looks_across).
  [[nodiscard]] RadarSet ahead() const { return ahead_; }
  /// Notes a scan of a radar, also of one that is left out. Radars that are silent for 0.5 s while
  /// others are heard are gone.
  void hear(std::size_t radar, std::int64_t stamp_us);
  /// Radars that are not gone.
  [[nodiscard]] RadarSet heard(std::int64_t at_us) const;
  /// Radars that look sideways, while one is heard that does not. Reflections on the objects that
  /// they pass move along with the vehicle: their positions shorten the way by 16 to 38 %, and are
  /// not used. Nor does their Doppler alone count as use of a scan (FilterCondition): without the
  /// others 1.8 % of the rows were beyond 5 sigma (passing vehicles, nuScenes).
  [[nodiscard]] RadarSet witnesses() const {
    return (heard(time_us_) & ahead_) != 0 ? first_radars(radars()) & ~ahead_ : 0U;
  }
  [[nodiscard]] bool is_witness(std::size_t radar) const { return contains(witnesses(), radar); }
  /// Whether no other radar that looks ahead or back is heard.
  [[nodiscard]] bool is_alone_ahead(std::size_t radar) const {
    return (heard(time_us_) & ahead_ & ~set_of(radar)) == 0;
  }
  /// To be called when the clock of the stamps was set.
  void leave_clock() { std::fill(heard_us_.begin(), heard_us_.end(), std::nullopt); }
  /// Velocity of a radar in the axes of the vehicle, without slip.
  [[nodiscard]] Eigen::Vector2d radar_velocity(std::size_t radar) const;
  /// Index in `gaussian` of one of a radar's errors.
  [[nodiscard]] int error(std::size_t radar, int which) const;
  /// Index of one of the errors of the vehicle's signals; only with options().vehicle.is_used().
  [[nodiscard]] int vehicle_error(int which) const;

  /// What the innovations since forget_faults() tell of offset, scale and delay of a signal of the
  /// vehicle's bus, if the other signal is right.
  struct FaultEvidence {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();  ///< Information times the faults.
    std::int64_t since_us = 0;
  };
  [[nodiscard]] const FaultEvidence& fault_evidence(VehicleSignal signal) const {
    return fault_evidence_[static_cast<std::size_t>(signal)];
  }
  /// A signal has errors with this mean and covariance, and is no longer used: corrects the state
  /// by what it followed of them.
  void correct_fault(VehicleSignal signal, const Eigen::Vector3d& errors,
                     const Eigen::Matrix3d& covariance);
  /// Index of the first of a signal's faults.
  static int fault_of(VehicleSignal signal) { return 3 * static_cast<int>(signal); }
  /// From now on looks for faults that begin now. To be called when the state may have followed
  /// anything else that was wrong.
  void forget_faults();
  void forget_faults(VehicleSignal signal);

  GaussianState gaussian;

 private:
  template <typename Visit>
  void for_each_error(Visit visit) const;
  [[nodiscard]] bool is_scale_observed() const;
  void start(const StateError& error);
  void start_scene_errors();
  void start_scene_errors(std::size_t radar);
  void advance(const StateError& error, double dt_s);
  bool grow(int state, double& variance, double to);
  void advance_skid(double dt_s);
  [[nodiscard]] double least_skid() const;
  [[nodiscard]] const std::vector<StateError>& signal_errors(VehicleSignal signal) const {
    return signal_errors_[static_cast<std::size_t>(signal)];
  }
  void set_scale_variance(std::size_t radar, double variance);
  void start_shared(int which, const SharedPrior& prior);

  OdometryOptions options_;
  std::int64_t time_us_ = 0;
  double excess_m2ps2_ = 0.0;      // The largest of the last scans.
  double mixture_variance_ = 0.0;  // Of the process of kMixture.
  bool is_skidding_ = false;
  double since_skid_s_ = std::numeric_limits<double>::infinity();
  double skid_variance_ = 0.0;  // Of the change of the slip, beyond its process.
  std::array<FaultEvidence, kVehicleSignals> fault_evidence_;
  std::vector<Pose2> mounts_;
  RadarSet ahead_;
  RadarSet along_;  // Within 27 degrees of the direction of travel.
  std::vector<std::optional<std::int64_t>> heard_us_;  // By radar: its last scan.
  std::vector<bool> is_turned_;
  SharedPrior mount_yaw_;
  SharedPrior doppler_scale_;
  // The table of errors.
  std::vector<StateError> common_errors_;
  std::vector<std::vector<StateError>> radar_errors_;
  std::vector<std::vector<StateError>> signal_errors_;  // None if no signal is used.
  /// Consider parameters of updates by Doppler or signals, by positions, and of all at rest.
  struct Considered {
    std::vector<GaussianState::Considered> by_velocities;
    std::vector<GaussianState::Considered> by_positions;
  };
  Considered considered_;
  Considered considered_without_scales_;  // While is_scale_observed() is false.
  std::vector<GaussianState::Considered> considered_at_rest_;
};

}  // namespace cremed
