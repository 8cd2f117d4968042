// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/doubt/vehicle/fault_cause.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// Which radars have a systematic fault: scale, sign, mount, time. As in receiver autonomous
/// integrity monitoring (RAIM) of satellite navigation the radars are compared with each other, not
/// with the filter, which may follow the wrong one.
///
/// Seven times a second, at a common time, each radar gives what it has of
///
///     velocity by Doppler        V = (v - w l_y, w l_x + s v)
///     speed and yaw rate by its own positions
///
/// with the errors that radars have anyway (OdometryOptions). v, w and slip s are unknown. A set of
/// radars is consistent if leaving out none of them lowers chi-square by more than kMaxDecrease on
/// average over a second. If all radars are not consistent, the largest sets that are, with up to
/// two radars less or of one radar, are the hypotheses. If one fits better than the others of its
/// size, the radars that are not in it are at fault; otherwise it is not known which.
///
/// Radars that look sideways are witnesses: their velocity across the vehicle counts, up to a limit
/// (they see passing vehicles), and they are not judged.
class FaultHypotheses {
 public:
  /// Uses options and mounts of `state`, which must outlive this object.
  explicit FaultHypotheses(const OdometryState& state);

  /// To be called when the clock of the stamps was set.
  void clear();
  /// A radar's own check found it wrong (SelfCheck).
  void accuse(std::size_t radar, std::int64_t time_us);
  /// Speed along x of the radar by its positions, over the last `since_s`. `variance_m2`: of the
  /// way, by the noise of the targets.
  void add_speed_by_positions(std::size_t radar, std::int64_t stamp_us, double speed_mps,
                              double since_s, double variance_m2);
  /// A scan has too few fixed targets to tell the speed.
  void add_too_few_targets(std::size_t radar, std::int64_t stamp_us);
  /// A motion by one radar alone, for its yaw rate.
  void add_motion(std::size_t radar, const EgoMotion& motion);
  /// The velocity of a scan; judges if that is due.
  void add_velocity(std::size_t radar, std::int64_t stamp_us, const DopplerVelocity& velocity);

  [[nodiscard]] bool is_at_fault(std::size_t radar) const { return verdicts_[radar].is_at_fault; }
  // Radars as bit sets.
  [[nodiscard]] std::uint32_t at_fault() const;
  /// Of a radar at fault.
  [[nodiscard]] FaultCause cause(std::size_t radar) const {
    return causes_[radar].cause(at_fault());
  }
  [[nodiscard]] std::uint32_t judged() const { return judged_; }
  /// No set is consistent, or several are: which radars are at fault is not known.
  [[nodiscard]] bool is_unknown() const { return unknown_epochs_ >= kMinEpochs; }
  /// The radars in use are consistent, a single one by its positions, if it has targets for that.
  [[nodiscard]] bool is_verified() const {
    return is_verified_ || (!needs_positions_ && !std::has_single_bit(judged_) && !is_unknown());
  }
  /// The odometry was lost since the beginning: see require_positions().
  [[nodiscard]] bool needs_positions() const { return needs_positions_; }
  /// The radars in use were found wrong by those that were not: the state is theirs. Once.
  bool take_reversal() { return std::exchange(is_reversed_, false); }
  /// (v, w, slip) by those that are believed, if a radar was found at fault since the last call:
  /// what was told with it may be wrong.
  std::optional<Eigen::Vector3d> take_correction();
  /// Two radars, each right by its own, differ by this share of the speed, and none tells which is
  /// wrong: both may be by that much. Once.
  std::optional<double> take_scale_in_dispute() {
    return std::exchange(is_newly_disputed_, false) ? std::optional(disputed_scale_) : std::nullopt;
  }
  /// To be called if the filter was lost: all radars may be wrong alike. From now on their
  /// positions must confirm them.
  void require_positions() {
    needs_positions_ = true;
    is_verified_ = false;
    supported_epochs_ = 0;
  }

 private:
  static constexpr std::size_t kEpochs = 7;
  /// So that one scan decides nothing.
  static constexpr std::size_t kMinEpochs = 3;
  static constexpr int kUnknowns = 3;  // v, w, s.
  using Set = std::uint32_t;           // Of radars, a bit each.

  struct Velocity {
    std::int64_t stamp_us = 0;
    Eigen::Vector2d mps = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  };
  struct YawRate {
    std::int64_t start_us = 0;
    std::int64_t end_us = 0;
    double radps = 0.0;
    double variance = 0.0;
  };
  struct Speed {
    std::int64_t stamp_us = 0;
    double mps = 0.0;
    double variance = 0.0;
    double variance_of_method = 0.0;  // Without the noise of the targets.
  };
  /// The newest scans of one radar.
  struct Track {
    std::array<Velocity, 2> velocities;  // The older first.
    std::array<YawRate, 2> yaw_rates;
    std::optional<Speed> speed;
    std::optional<std::int64_t> too_few_targets_us;
    std::optional<std::int64_t> accused_us;
    int count = 0;  // Of velocities.
  };
  /// Sums of least squares: information H, H x, and x' H x of the measurements.
  struct Sums {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
    double squares = 0.0;

    void add(const Eigen::Vector3d& derivative, double value, double variance);
    void add(const Sums& other);
    [[nodiscard]] Eigen::Vector3d solution() const;
    [[nodiscard]] double chi_square() const;
  };
  using Epoch = std::vector<Sums>;  // By radar.
  using Velocities = std::vector<std::optional<Velocity>>;
  struct Verdict {
    bool is_at_fault = false;
    bool is_accused = false;               // By its own check.
    std::optional<std::int64_t> until_us;  // None: not yet by the clock as it was set.
    std::int64_t hold_us = 0;
    std::int64_t shared_hold_us = 0;  // If most radars are at fault by their own checks.
  };
  /// Of the radars in a set with each other, and of the witnesses with them.
  struct Fit {
    double of_set = 0.0;
    double of_witnesses = 0.0;

    [[nodiscard]] double chi_square() const { return of_set + of_witnesses; }
  };
  struct Hypothesis {
    Set set = 0;
    double chi_square = 0.0;
    int rivals = 0;  // Consistent sets of the same size that fit as well.
  };

  [[nodiscard]] std::optional<Velocity> velocity_at(std::size_t radar, std::int64_t time_us) const;
  [[nodiscard]] Sums by_doppler(std::size_t radar, const Velocity& velocity) const;
  [[nodiscard]] Sums measurements(std::size_t radar, std::int64_t time_us,
                                  const Velocity& velocity) const;
  [[nodiscard]] std::optional<std::int64_t> common_time() const;
  void observe(std::int64_t time_us);
  void convict(std::size_t radar, std::int64_t time_us);
  [[nodiscard]] bool is_misjudged(Set set) const;
  void acquit(Set set);
  void judge(std::int64_t time_us);
  [[nodiscard]] Set present() const;
  [[nodiscard]] bool contradict_positions() const;
  [[nodiscard]] Hypothesis best_hypothesis() const;
  [[nodiscard]] Hypothesis search(Set present) const;
  void try_set(Set set, Hypothesis& best) const;
  void try_smaller(Set set, Hypothesis& best) const;
  [[nodiscard]] bool is_supported(Set set, std::int64_t time_us) const;
  [[nodiscard]] bool is_refuted(Set set, std::int64_t time_us) const;
  [[nodiscard]] bool is_wrong_by_itself(std::size_t radar, std::int64_t time_us) const;
  [[nodiscard]] bool is_consistent(Set set, double chi_square) const;
  [[nodiscard]] Fit fit(Set set) const;
  [[nodiscard]] Sums prior() const;
  [[nodiscard]] Sums sum(Set set, const Epoch& epoch) const;
  [[nodiscard]] const Epoch& newest_epoch() const { return epochs_[(count_ - 1) % kEpochs]; }
  void search_causes(Set believed, std::int64_t time_us);
  void allow_for_scale();

  const OdometryState& state_;
  Set judged_ = 0;  // The radars that do not look sideways.
  std::vector<Track> tracks_;
  std::vector<Verdict> verdicts_;
  std::vector<FaultCauseSearch> causes_;
  std::array<Epoch, kEpochs> epochs_;
  Velocities velocities_;  // Of the newest epoch.
  std::size_t count_ = 0;  // Of epochs.
  std::int64_t newest_us_ = 0;
  std::int64_t epoch_us_ = 0;
  std::size_t unknown_epochs_ = 0;
  std::size_t supported_epochs_ = 0;
  bool needs_positions_ = false;
  bool is_verified_ = false;
  bool is_reversed_ = false;
  bool is_newly_convicted_ = false;
  double disputed_scale_ = 0.0;
  bool is_newly_disputed_ = false;
};

}  // namespace cremed
