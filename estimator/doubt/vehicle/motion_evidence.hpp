// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/cost/yaw_by_positions.hpp"
#include "cremed/estimator/doubt/radar/speed_jump.hpp"
#include "cremed/estimator/doubt/vehicle/motion_sums.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// Decrease of chi-square by any slip that shows a slip that no vehicle has unless it skids, as for
/// a radar at fault. Its mean over the epochs is 2.9 at most on healthy drives, backwards 4.2
/// (RadarScenes 105).
inline constexpr double kDecreaseByImpossibleSlip = 8.0;
/// Decrease with which a skid is over, or radars that showed such a slip are believed again.
inline constexpr double kDecreaseByUsualSlip = 4.0;
/// Limit of the chi-square of a radar that looks sideways (a witness): it sees passing vehicles.
inline constexpr double kMaxWitness = 9.0;

/// What the radars measure of the vehicle's motion, in epochs: seven times a second, at a common
/// time, each radar's
///
///     velocity by Doppler        V = (v - w l_y, w l_x + s v)
///     speed and yaw rate by its own positions
///
/// with the errors of healthy radars (OdometryOptions). v, w and slip s are unknown.
class MotionEvidence {
 public:
  /// Velocity of a radar, in the axes of the vehicle.
  struct Velocity {
    std::int64_t stamp_us = 0;
    Eigen::Vector2d mps = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  };

  /// Uses options and mounts of `state`, which must outlive this object.
  explicit MotionEvidence(const OdometryState& state);

  /// To be called when the clock of the stamps was set.
  void clear();
  /// See FaultHypotheses.
  void add_speed_by_positions(std::size_t radar, std::int64_t stamp_us, double speed_mps,
                              double since_s, double variance_m2);
  void add_too_few_targets(std::size_t radar, std::int64_t stamp_us) {
    tracks_[radar].too_few_targets_us = stamp_us;
  }
  void add_accusation(std::size_t radar, std::int64_t time_us) {
    tracks_[radar].accused_us = time_us;
  }
  void add_motion(std::size_t radar, const EgoMotion& motion);
  /// The speed of all radars changed by this, more than a vehicle's can: each is suspect until its
  /// speed steps again, or jumps back. None: positions confirm the speed, and no radar is suspect.
  void set_after_step(std::optional<double> step_mps);
  /// True once after all radars stepped again.
  bool take_step_back() { return std::exchange(has_stepped_back_, false); }
  /// True if this completes an epoch.
  bool add_velocity(std::size_t radar, std::int64_t stamp_us, const DopplerVelocity& velocity);
  /// Radars whose speed jumped (SpeedJump) while that of another surely did not. Each jump is
  /// judged once, when all radars that are heard have measured since.
  RadarSet take_jumped();
  /// A jump of the only radar that is heard of the judged ones; returned once.
  std::optional<SpeedJump::Jump> take_lone_jump() { return std::exchange(lone_jump_, {}); }
  /// Jumps until now are not judged any more.
  void forget_jumps() {
    take_jumped();
    lone_jump_.reset();
  }
  /// Epochs until now are not compared any more.
  void forget_epochs() { count_ = 0; }
  /// From now on the Doppler scales of the judged radars may be off by `share`.
  void allow_for_scale(double share) {
    disputed_scale_ = share;
    forget_epochs();
  }

  /// The radars that do not look sideways.
  [[nodiscard]] RadarSet judged() const { return state_.ahead(); }
  /// The radars that look sideways.
  [[nodiscard]] RadarSet witnesses() const { return first_radars(tracks_.size()) & ~judged(); }
  [[nodiscard]] double disputed_scale() const { return disputed_scale_; }

  static constexpr std::size_t kEpochs = 7;  ///< A second.
  /// Number of epochs that are compared: a second, less after a start, a gap or a step back.
  [[nodiscard]] std::size_t epochs() const { return std::min(count_, kEpochs); }
  /// Means of chi-square over the epochs: of the radars in a set with each other, and of the
  /// witnesses with them.
  struct Fit {
    double of_set = 0.0;
    double of_witnesses = 0.0;
    double of_worst_witness = 0.0;  ///< 0 if there is only one.

    [[nodiscard]] double chi_square() const { return of_set + of_witnesses; }
  };
  /// Two radars of which only Doppler counts, at their own mounts or at each other's.
  struct Pair {
    std::size_t one;
    std::size_t other;
    bool is_exchanged;
  };
  /// The slip that a fit allows: that of a vehicle that does not skid, or any (sigma 17 degrees).
  /// Yaw rates by registration with Doppler hold with a usual slip only; those by positions alone
  /// always, but they err more than their covariance says: they count where slip is in question.
  enum class Slip : std::uint8_t { usual, usual_by_positions, any };
  [[nodiscard]] Fit fit(RadarSet set, std::optional<Pair> pair = std::nullopt,
                        Slip slip = Slip::usual) const;
  /// Chi-square of set and witnesses in each epoch; if the set is one radar, without the worst
  /// witness. 0 if the set is empty or the epoch missing.
  using ChiSquares = std::array<double, kEpochs>;
  [[nodiscard]] ChiSquares chi_squares(RadarSet set, std::optional<Pair> pair, Slip slip) const;
  /// Decrease of the mean chi-square of a set if the vehicle may have any slip.
  [[nodiscard]] double decrease_by_slip(RadarSet set) const {
    return fit(set, {}, Slip::usual_by_positions).of_set - fit(set, {}, Slip::any).of_set;
  }

  // In the newest epoch:
  [[nodiscard]] std::int64_t time_us() const { return time_us_; }
  [[nodiscard]] RadarSet present() const;  ///< Judged radars with a velocity.
  [[nodiscard]] const std::optional<Velocity>& velocity(std::size_t radar) const {
    return newest_epoch()[radar].velocity;
  }
  /// A radar's speed by Doppler minus that by a set of radars: means over the epochs.
  struct SpeedDifference {
    double speed_mps = 0.0;
    double difference_mps = 0.0;
    double std_mps = 0.0;  ///< By the noise of the targets.
  };
  [[nodiscard]] SpeedDifference speed_difference(std::size_t radar, RadarSet set) const;
  /// The speed of a radar by its positions over that by its Doppler, means over the newest epochs.
  /// None if they differ by less than so many `limits`, or if half of so many epochs have not both,
  /// positions compared over `min_since_s` or more.
  [[nodiscard]] std::optional<double> scale_by_positions(std::size_t radar, std::size_t newest,
                                                         double min_since_s, double limits) const;
  /// All measurements of the radars in the set, with the prior.
  [[nodiscard]] MotionSums sum(RadarSet set) const {
    return sum(set, newest_epoch(), {}, state_.options().start_yaw_rate_std_radps, Slip::usual);
  }
  /// Their Doppler only.
  [[nodiscard]] MotionSums sum_by_doppler(RadarSet set) const;
  /// Motions (v, w, slip) over the epochs by a set of radars, if the vehicle may have any slip.
  struct MotionWithSlip {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double least_slip_rad = 0.0;
    double largest_slip_rad = 0.0;
  };
  [[nodiscard]] MotionWithSlip motion_with_slip(RadarSet set) const;
  /// Mean motion by the radars that are present, over the epochs that fit only if the slip may be
  /// larger than a vehicle's. That is how a lone radar with a turned mount looks.
  [[nodiscard]] std::optional<Eigen::Vector3d> motion_with_impossible_slip() const;
  /// Doppler of a radar that is present.
  [[nodiscard]] MotionSums by_doppler(std::size_t radar) const {
    return by_doppler(radar, *velocity(radar));
  }
  /// Whether positions confirm the speed of at least one radar of the set, or no radar of it has
  /// enough targets to check it.
  [[nodiscard]] bool is_supported(RadarSet set) const;
  /// Whether a radar of the set that is heard is suspect (set_after_step()).
  [[nodiscard]] bool is_after_step(RadarSet set) const;
  /// A radar's own check found it wrong, in one of its last scans.
  [[nodiscard]] bool is_accused(std::size_t radar) const {
    return tracks_[radar].accused_us && is_fresh(*tracks_[radar].accused_us);
  }

 private:
  struct Speed {
    std::int64_t stamp_us = 0;
    double mps = 0.0;
    double variance = 0.0;
    double variance_of_method = 0.0;  // Without the noise of the targets.
    double since_s = 0.0;             // Time over which positions are compared.
  };
  struct Measured {
    std::optional<Velocity> velocity;
    std::optional<Speed> speed_by_positions;
    MotionSums all;               // With yaw rates by registration with Doppler.
    MotionSums all_by_positions;  // By positions alone.
  };
  using Epoch = std::vector<Measured>;  // By radar.

  struct YawRate {
    std::int64_t start_us = 0;
    std::int64_t end_us = 0;
    double radps = 0.0;
    double variance = 0.0;
    double by_positions_radps = 0.0;
    double variance_by_positions = 0.0;
  };
  /// The newest scans of one radar.
  struct Track {
    std::array<Velocity, 2> velocities;  // The older first.
    std::array<YawRate, 2> yaw_rates;
    std::optional<Speed> speed;
    std::optional<std::int64_t> too_few_targets_us;
    std::optional<std::int64_t> accused_us;
    bool is_after_step = false;
    SpeedJump jumps;
    std::optional<SpeedJump::Jump> jump;  // Not yet judged.
    int count = 0;                        // Of velocities.
  };

  /// Radars with a velocity in the last scan periods.
  [[nodiscard]] RadarSet heard() const;
  [[nodiscard]] bool is_step(std::size_t radar) const;
  [[nodiscard]] std::optional<std::int64_t> common_time() const;
  void observe(std::int64_t time_us);
  [[nodiscard]] bool is_fresh(std::int64_t stamp_us) const;
  [[nodiscard]] std::optional<Velocity> velocity_at(std::size_t radar, std::int64_t time_us) const;
  [[nodiscard]] MotionSums by_doppler(std::size_t mount, const Velocity& velocity) const;
  [[nodiscard]] std::optional<Speed> speed_by_positions(std::size_t radar) const;
  [[nodiscard]] MotionSums measurements(std::size_t radar, const Measured& measured,
                                        Slip slip) const;
  [[nodiscard]] MotionSums prior(double yaw_rate_std_radps) const;
  void add_slip(MotionSums& sum, Slip slip) const;
  [[nodiscard]] double turn_std_radps(const Epoch& epoch) const;
  [[nodiscard]] MotionSums by_doppler_at(std::size_t radar, std::size_t mount,
                                         const std::optional<Velocity>& velocity) const;
  [[nodiscard]] MotionSums sum(RadarSet set, const Epoch& epoch, std::optional<Pair> pair,
                               double yaw_rate_std_radps, Slip slip) const;
  [[nodiscard]] Fit fit(RadarSet set, const Epoch& epoch, std::optional<Pair> pair,
                        Slip slip) const;
  [[nodiscard]] const Epoch& newest_epoch() const { return epochs_[(count_ - 1) % kEpochs]; }

  const OdometryState& state_;
  std::vector<Track> tracks_;
  std::array<Epoch, kEpochs> epochs_;
  std::size_t count_ = 0;  // Of epochs.
  std::int64_t newest_us_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t time_us_ = 0;
  double disputed_scale_ = 0.0;
  std::optional<double> step_mps_;
  std::optional<SpeedJump::Jump> lone_jump_;
  bool has_stepped_back_ = false;
};

}  // namespace cremed
