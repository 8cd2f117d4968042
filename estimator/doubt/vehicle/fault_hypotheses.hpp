// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/doubt/vehicle/common_scale.hpp"
#include "cremed/estimator/doubt/vehicle/consistent_set.hpp"
#include "cremed/estimator/doubt/vehicle/convictions.hpp"
#include "cremed/estimator/doubt/vehicle/fault_cause.hpp"
#include "cremed/estimator/doubt/vehicle/motion_evidence.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// Which radars have a systematic fault: scale, sign, mount, time. As in receiver autonomous
/// integrity monitoring (RAIM) of satellite navigation the radars are compared with each other
/// (MotionEvidence), not with the filter, which may follow the wrong radar.
///
/// If one set of radars is consistent and fits better than the others of its size (ConsistentSet),
/// the radars that are not in it are at fault (Convictions); otherwise it is unknown which are.
///
/// Radars that look sideways are witnesses. They see passing vehicles: they are not judged, and
/// their chi-square, mostly of the velocity across the vehicle, counts up to a limit.
class FaultHypotheses {
 public:
  /// Uses options and mounts of `state`, which must outlive this object.
  explicit FaultHypotheses(const OdometryState& state);

  /// To be called when the clock of the stamps was set.
  void clear();
  /// A radar's own check found it wrong (SelfCheck).
  void accuse(std::size_t radar, std::int64_t time_us);
  /// Notes that a radar's own check finds its speed wrong (SelfCheck), and the factor on Doppler
  /// that corrects it, if that is known. True if it is not the error of this radar: at least two
  /// others have the same speed, and their own checks found nothing wrong for 5 s; or all share it
  /// (common_scale()).
  bool refutes_speed_doubt(std::size_t radar, std::int64_t time_us, std::optional<double> factor);
  /// What was measured until now is not compared any more: a skid has ended, or a mount was learned
  /// anew.
  void pause();
  /// The state begins anew: a skid that it saw, and a scale that Doppler had, are not judged.
  void forget_skid();
  /// MotionEvidence::motion_with_impossible_slip() if it is not known which radars are wrong.
  [[nodiscard]] std::optional<Eigen::Vector3d> motion_with_impossible_slip() const {
    return is_unknown() ? evidence.motion_with_impossible_slip() : std::nullopt;
  }
  /// The velocity of a scan by Doppler; judges the radars if that completes an epoch.
  void add_velocity(std::size_t radar, std::int64_t stamp_us, const DopplerVelocity& velocity);

  [[nodiscard]] RadarSet at_fault() const { return convictions_.at_fault(); }
  [[nodiscard]] bool is_at_fault(std::size_t radar) const { return contains(at_fault(), radar); }
  /// The error that explains a radar at fault, or the one of all judged radars: their mounts are
  /// turned alike.
  [[nodiscard]] FaultCause cause(std::size_t radar) const;
  /// Mean motion (v, w, slip) of a second in which all judged radars agreed on a slip that no
  /// vehicle has: their mounts are turned alike.
  [[nodiscard]] const std::optional<Eigen::Vector3d>& common_motion() const {
    return common_motion_;
  }
  /// An error of the Doppler scale that all radars share.
  [[nodiscard]] const std::optional<CommonScale::Finding>& common_scale() const {
    return common_scale_;
  }
  /// To be called if common_scale() corrects Doppler from now on: its radars are believed again.
  void note_scale_learned();
  /// The vehicle seems to skid: the radars are not compared.
  [[nodiscard]] bool is_skidding() const { return is_skidding_; }
  /// No set is consistent, or several are: which radars are at fault is not known.
  [[nodiscard]] bool is_unknown() const { return unknown_epochs_ >= kMinEpochs; }
  /// The radars in use were compared and are consistent, a single one with its positions, if it has
  /// targets for that.
  [[nodiscard]] bool is_verified() const {
    return is_verified_ || (!needs_positions_ && !is_exchange_open_ && unknown_epochs_ == 0 &&
                            evidence.epochs() >= kMinEpochs &&
                            (evidence.judged() == 0 || std::popcount(evidence.present()) > 1));
  }
  /// The odometry was lost at least once: see require_positions().
  [[nodiscard]] bool needs_positions() const { return needs_positions_; }
  /// True once after a verdict was reversed: the radars in use, which the state follows, are wrong,
  /// and radars that they had convicted are right.
  bool take_reversal() { return std::exchange(is_reversed_, false); }
  /// True once after a step of all radars (require_positions()), when all stepped back: the fault
  /// has ended.
  bool take_step_back();
  /// (v, w, slip) by the believed radars, if a radar was found at fault since the last call: the
  /// state, which used it, may be wrong.
  std::optional<Eigen::Vector3d> take_correction();
  /// If two radars that are each confirmed by their own positions disagree about the speed: the
  /// relative difference, by which either scale may be wrong. Returned once.
  std::optional<double> take_scale_in_dispute() {
    return std::exchange(is_newly_disputed_, false) ? std::optional(evidence.disputed_scale())
                                                    : std::nullopt;
  }
  /// Whether a radar's own check (SelfCheck) has not decided about its speed yet.
  void note_speed_undecided(std::size_t radar, bool is_undecided) {
    speed_undecided_ = (speed_undecided_ & ~set_of(radar)) | (is_undecided ? set_of(radar) : 0U);
  }
  /// To be called if the filter was lost: all radars may be wrong alike, and are believed again
  /// only if their positions confirm them. `step_mps`: change of the speed of all radars, or of the
  /// only one ahead, if it stepped (MajorityFollower). Until they step back, scans at rest do not
  /// count as confirmation: targets that do not move always fit the map.
  void require_positions(std::optional<double> step_mps);

  /// What the radars are compared by. Velocities go through add_velocity(), accusations through
  /// accuse(); yaw rates and speeds by positions are added directly.
  MotionEvidence evidence;

 private:
  /// So that one scan decides nothing.
  static constexpr std::size_t kMinEpochs = 3;

  bool is_skid();
  [[nodiscard]] std::optional<CommonScale::Finding> find_common_scale() const;
  /// A verdict stands: those found at fault do not make the others agree with them.
  [[nodiscard]] SlipRule slip_rule() const {
    return {is_unknown() ? kDecreaseByUsualSlip : kDecreaseByImpossibleSlip,
            is_unknown() || (at_fault() & evidence.present()) == 0};
  }
  void convict(RadarSet set, std::int64_t time_us);
  void judge();
  void acquit_misjudged();
  void reverse(RadarSet misjudged);
  void verify(const ConsistentSet& best, bool is_known);
  void convict_others(RadarSet believed);
  [[nodiscard]] bool is_refuted(RadarSet set) const;
  [[nodiscard]] bool is_wrong_by_itself(std::size_t radar) const;
  [[nodiscard]] bool is_speed_undecided(RadarSet set) const;
  [[nodiscard]] bool is_at_rest(RadarSet set) const;
  void allow_for_scale();
  void begin_search(std::size_t radar);
  RadarSet search_causes(RadarSet believed);
  void convict_by_cause(RadarSet compared);
  void convict_late_others();
  void note_finding_of_two(std::size_t radar, const FaultCauseSearch::Finding& finding);

  const OdometryState& state_;
  Convictions convictions_;
  std::vector<FaultCauseSearch> causes_;
  CommonScale scale_;
  RadarSet speed_undecided_ = 0;  // By own checks.
  /// Which of two radars seems to be at fault, and for how many epochs that has been the same.
  struct OfTwo {
    std::size_t radar = 0;
    FaultCause cause;
    std::size_t epochs = 0;
  };
  OfTwo of_two_;
  std::size_t unknown_epochs_ = 0;
  std::size_t supported_epochs_ = 0;
  bool needs_positions_ = false;
  bool is_verified_ = false;
  /// At a start a radar with a wrong sign and two that are exchanged explain the data equally well.
  bool is_exchange_open_ = false;
  bool is_reversed_ = false;
  bool is_newly_disputed_ = false;
  std::optional<Eigen::Vector3d> common_motion_;
  std::optional<CommonScale::Finding> common_scale_;
  bool is_skidding_ = false;
  std::optional<std::int64_t> slip_changed_us_;  // Of the vehicle that skids: last not steady.
  bool was_paused_ = false;  // After a pause a verdict needs the full number of epochs.
};

}  // namespace cremed
