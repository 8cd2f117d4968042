// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/fault_hypotheses.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Largest difference of the Doppler scales of two radars that is left to the filter, which learns
/// scales by positions. Larger ones are found by a radar's own positions (DopplerScale).
constexpr double kMaxDisputedScale = 0.05;
/// Least decrease of chi-square by a cause over ten seconds, beyond chance. Healthy radars of
/// nuScenes 0061, 0103, 0655, 0796, 1094 and RadarScenes 105 have 7.0 at most (mount x), and 6.9
/// backwards; of simulated regimes with few targets 5.7 (lateness).
constexpr double kMinGain = 25.0;

/// Largest chi-square of the believed radars in an epoch that is used to search for causes, of
/// three or more radars; consistent sets have 1 to 5. In the epoch before one of three radars is
/// found at fault it is still among those with which the others are compared.
constexpr double kMaxChiSquareOfEpoch = 32.0;

/// Least decrease by lateness of one of two radars, where no third one decides: healthy ones with
/// 0.45 of their targets have 35.3 (105, unflagged), one that is 0.3 s late 39 to 43.
constexpr double kMinGainOfLateness = 37.5;
/// Of two radars one is at fault if the finding stays the same for a second. If another fault looks
/// like a delay, that changes by a second in this time.
constexpr std::size_t kEpochsOfTwo = 7;
constexpr double kMaxChangeOfDelayS = 0.05;

/// Of radars whose axes differ by less either may be upside down: twice this is the slip with which
/// the other one would be, six times what is left open (VelocityMoments::Errors of healthy radars).
constexpr double kMinBetweenAxesRad = 0.05;

/// Radars whose speeds differ by less than this share have the same speed. A larger error of scale
/// is found by the radar's own check (DopplerScale).
constexpr double kMaxShareShared = 0.03;

/// Two degrees: more than the error of mounts measured by hand.
constexpr double kMinNamedTurnRad = 0.035;
/// Longest time for which a vehicle skids with the same slip. A test drives two seconds so.
constexpr double kMaxSteadyS = 4.0;
/// Change of a slip that stays, within a second: with 0.09 the noise of a turned radar at 6 m/s
/// (1094) looked like a skid at times.
constexpr double kMaxChangeOfSlipRad = 0.12;
/// Decrease of chi-square by any slip beyond which a skid needs no agreement: registrations without
/// sideways motion fail then. 14 degrees have 100 to 300. Two radars turned by 5 degrees have 42 at
/// most; if they turn by 10, they are found before the mean over a second gets there.
constexpr double kDecreaseOfSkid = 100.0;

/// Whether the error is larger than those of healthy radars and than what the filter learns.
bool is_grave(const FaultCause& cause) {
  switch (cause.kind) {
    case FaultKind::scale:
      return std::abs(cause.value - 1.0) > 0.02;
    case FaultKind::offset:
      return std::abs(cause.value) > 0.2;
    case FaultKind::late:
      return cause.value > 0.15;
    case FaultKind::mount_x:
      return std::abs(cause.value) > 1.0;
    case FaultKind::sign:
    case FaultKind::upside_down:
      return true;
    default:
      return false;
  }
}

}  // namespace

FaultHypotheses::FaultHypotheses(const OdometryState& state)
    : evidence(state), state_(state), convictions_(state.radars()), scale_(state.radars()) {
  for (std::size_t i = 0; i < state.radars(); ++i) {
    causes_.emplace_back(state.mounts(), i);
  }
}

/// Of two rear radars that are turned alike one may fit the mount of the other, which is at its
/// own.
FaultCause FaultHypotheses::cause(std::size_t radar) const {
  const RadarSet movable =
      filter(at_fault(), [&](std::size_t i) { return !causes_[i].is_at_own_mount(at_fault()); });
  const FaultCause own = is_at_fault(radar) ? causes_[radar].cause(movable) : FaultCause();
  const bool may_be_common = own.kind == FaultKind::unknown && common_motion_ && is_unknown() &&
                             contains(evidence.judged(), radar);
  if (!may_be_common) {
    return own;
  }
  const double turned_rad = state_.turned_rad(radar) - common_motion_->z();
  return std::abs(turned_rad) > kMinNamedTurnRad ? FaultCause{FaultKind::mount_yaw, turned_rad}
                                                 : own;
}

void FaultHypotheses::clear() {
  evidence.clear();
  convictions_.leave_clock();
  for (FaultCauseSearch& cause : causes_) {
    cause.forget();
  }
  scale_.forget();
  forget_skid();
  common_motion_.reset();
  unknown_epochs_ = 0;
  was_paused_ = false;
}

/// Not while radars may be exchanged: their positions are wrong as well.
std::optional<CommonScale::Finding> FaultHypotheses::find_common_scale() const {
  return is_exchange_open_ ? std::nullopt
                           : scale_.find(evidence, at_fault(), convictions_.accused());
}

bool FaultHypotheses::refutes_speed_doubt(std::size_t radar, std::int64_t time_us,
                                          std::optional<double> factor) {
  scale_.note_doubt(radar, time_us, factor);
  if (const auto shared = find_common_scale(); shared && contains(shared->radars, radar)) {
    return true;
  }
  const RadarSet present = evidence.epochs() == 0 ? 0U : evidence.present();
  const RadarSet others =
      filter(present & ~at_fault(), [&](std::size_t i) { return !scale_.is_doubted(i, time_us); });
  if (std::popcount(others) < 2) {
    return false;
  }
  const auto shared = evidence.speed_difference(radar, others);
  return std::abs(shared.difference_mps) + 2.0 * shared.std_mps <
         kMaxShareShared * std::abs(shared.speed_mps);
}

void FaultHypotheses::accuse(std::size_t radar, std::int64_t time_us) {
  begin_search(radar);
  evidence.add_accusation(radar, time_us);
  convictions_.accuse(radar, state_.heard(time_us) & evidence.judged(), time_us);
}

void FaultHypotheses::pause() {
  evidence.forget_epochs();
  forget_skid();
  common_motion_.reset();
  unknown_epochs_ = 0;
  supported_epochs_ = 0;
  was_paused_ = true;
}

void FaultHypotheses::note_scale_learned() {
  convictions_.acquit(common_scale_->radars);
  evidence.clear();  // With the Doppler before.
  scale_.forget();
  pause();
}

void FaultHypotheses::add_velocity(std::size_t radar, std::int64_t stamp_us,
                                   const DopplerVelocity& velocity) {
  const bool is_due = evidence.add_velocity(radar, stamp_us, velocity);
  is_skidding_ = is_due ? is_skid() : is_skidding_;
  if (is_skidding_) {
    evidence.forget_jumps();
    common_scale_.reset();
    unknown_epochs_ = 0;
    return;
  }
  // Their speed jumped, and that of other radars did not: it was not the vehicle.
  convict(evidence.take_jumped() & ~at_fault(), stamp_us);
  if (is_due && evidence.epochs() >= (was_paused_ ? MotionEvidence::kEpochs : kMinEpochs)) {
    was_paused_ = false;
    judge();
  }
}

/// Whether the vehicle skids: the state saw it begin while it was known which radars are right, and
/// they agree on the slip. To be called with each epoch.
bool FaultHypotheses::is_skid() {
  const bool seems_so = state_.skid_variance() > 0.0;
  const RadarSet present = evidence.present();
  if (!slip_changed_us_ && (!seems_so || is_unknown())) {
    return false;
  }
  if (slip_changed_us_ && std::popcount(present) < 2) {
    return is_skidding_;  // One radar tells nothing new.
  }
  const double decrease = evidence.decrease_by_slip(present);
  if (!seems_so && decrease <= kDecreaseByUsualSlip) {
    pause();
    return false;
  }
  const auto motion = evidence.motion_with_slip(present);
  const bool is_steady = evidence.epochs() == MotionEvidence::kEpochs &&
                         motion.largest_slip_rad - motion.least_slip_rad < kMaxChangeOfSlipRad;
  if (!slip_changed_us_ || (!is_steady && !is_unknown())) {
    slip_changed_us_ = evidence.time_us();
  }
  return seconds_between(*slip_changed_us_, evidence.time_us()) < kMaxSteadyS &&
         (decrease > kDecreaseOfSkid || agree_on_slip(evidence, present));
}

void FaultHypotheses::forget_skid() {
  common_scale_.reset();
  slip_changed_us_.reset();
  is_skidding_ = false;
}

void FaultHypotheses::convict(RadarSet set, std::int64_t time_us) {
  for_each(set, [&](std::size_t i) {
    begin_search(i);
    convictions_.convict(i, time_us);
  });
}

std::optional<Eigen::Vector3d> FaultHypotheses::take_correction() {
  if (evidence.epochs() == 0 || !convictions_.take_new()) {
    return std::nullopt;
  }
  const RadarSet believed = evidence.present() & ~at_fault();
  return believed == 0 ? std::nullopt : std::optional(evidence.sum(believed).solution());
}

bool FaultHypotheses::take_step_back() {
  const bool has_stepped_back = evidence.take_step_back();
  if (has_stepped_back) {
    convictions_.acquit(convictions_.accused());
    unknown_epochs_ = 0;
  }
  return has_stepped_back;
}

void FaultHypotheses::require_positions(std::optional<double> step_mps) {
  if (step_mps) {
    evidence.set_after_step(step_mps);
  }
  needs_positions_ = true;
  is_verified_ = false;
  supported_epochs_ = 0;
}

void FaultHypotheses::judge() {
  common_scale_ = find_common_scale();
  acquit_misjudged();
  const ConsistentSet best = find_consistent_set(evidence, at_fault(), slip_rule());
  // Radars are not exchanged while driving.
  is_exchange_open_ = best.is_exchange_possible && !is_verified_;
  common_motion_.reset();
  if (is_exchange_open_) {
    return;
  }
  const bool is_known = evidence.judged() == 0 || (best.radars != 0 && best.rivals == 0);
  unknown_epochs_ = is_known ? 0 : unknown_epochs_ + 1;
  if (best.agrees_on_slip && unknown_epochs_ >= MotionEvidence::kEpochs) {
    common_motion_ = evidence.motion_with_slip(evidence.present()).mean;
  }
  if (unknown_epochs_ == kMinEpochs && best.rivals > 0) {
    for_each(evidence.present(), [&](std::size_t i) { begin_search(i); });
    allow_for_scale();
    return;
  }
  verify(best, is_known);
  const RadarSet before = at_fault();
  convict_others(is_known ? best.radars : 0U);
  for_each(before & ~at_fault(), [&](std::size_t i) { causes_[i].clear(); });
  if (is_known) {
    convict_by_cause(search_causes(best.radars & ~at_fault()));
    convict_late_others();
  } else if (std::popcount(evidence.present()) == 2 && at_fault() == 0) {
    convict_by_cause(search_causes(evidence.present()));
  }
}

/// Acquits radars that their own positions confirm if all others are wrong by their own checks: the
/// verdict of those others is wrong as well, however many they were.
void FaultHypotheses::acquit_misjudged() {
  const RadarSet misjudged = evidence.present() & at_fault() & ~convictions_.accused();
  const RadarSet others = evidence.present() & ~misjudged;
  if (misjudged != 0 && others != 0 && (others & ~convictions_.accused()) == 0 &&
      is_consistent(evidence, misjudged, 0U)) {
    reverse(misjudged);
  }
}

void FaultHypotheses::reverse(RadarSet misjudged) {
  convictions_.acquit(misjudged);
  is_reversed_ = true;
}

void FaultHypotheses::verify(const ConsistentSet& best, bool is_known) {
  const bool is_heard = evidence.judged() == 0 || evidence.present() != 0;
  const bool is_supported = is_known && is_heard && evidence.is_supported(best.radars) &&
                            !(needs_positions_ && is_refuted(best.radars)) &&
                            !is_speed_undecided(best.radars) &&
                            !(evidence.is_after_step(best.radars) && is_at_rest(best.radars));
  supported_epochs_ = is_supported ? supported_epochs_ + 1 : 0;
  is_verified_ = (is_verified_ || supported_epochs_ >= kMinEpochs) && !is_unknown();
  if (is_verified_) {
    evidence.set_after_step(std::nullopt);
  }
}

/// The own check of the only radar that is heard does not know yet whether its speed is right.
bool FaultHypotheses::is_speed_undecided(RadarSet set) const {
  const RadarSet present = set & evidence.present();
  return std::has_single_bit(present) && (present & ~speed_undecided_) == 0;
}

bool FaultHypotheses::is_at_rest(RadarSet set) const {
  return std::abs(evidence.sum(set).solution().x()) < state_.options().standstill_mps;
}

/// `believed`: 0 if it is not known which are right.
void FaultHypotheses::convict_others(RadarSet believed) {
  const RadarSet present = evidence.present();
  const RadarSet misjudged = at_fault() & ~convictions_.accused();
  // If radars that are now found wrong convicted all the believed ones, that verdict is reversed.
  if (believed != 0 && (present & ~at_fault() & ~believed) != 0 &&
      (believed & present & ~misjudged) == 0) {
    reverse(believed);
  }
  // Radars that are all at fault may agree because they have the same fault: they convict none.
  const RadarSet others = (believed & ~at_fault()) != 0 ? evidence.judged() & ~believed : 0U;
  convict(others, evidence.time_us());
  convictions_.release(evidence.time_us());
}

/// Whether a radar that is wrong by itself agrees with the Doppler of the set: the set then has the
/// same fault.
bool FaultHypotheses::is_refuted(RadarSet set) const {
  const MotionSums joint = evidence.sum(set);
  return any_of(evidence.present(), [&](std::size_t radar) {
    MotionSums with = joint;
    with.add(contains(set, radar) ? MotionSums() : evidence.by_doppler(radar));
    return is_wrong_by_itself(radar) && with.chi_square() - joint.chi_square() <= kMaxDecrease;
  });
}

/// Whether a radar's positions contradict its Doppler. At rest, where positions of all scans fit
/// the same map, its own check counts too; while driving it would find the end of a fault a second
/// later.
bool FaultHypotheses::is_wrong_by_itself(std::size_t radar) const {
  const bool is_accused_at_rest =
      evidence.is_accused(radar) &&
      evidence.velocity(radar)->mps.norm() < state_.options().standstill_mps;
  return is_accused_at_rest || !is_consistent(evidence, set_of(radar), at_fault());
}

/// If the only two radars differ by a few percent of the speed, they are used with each scale as
/// uncertain as that, and judged anew.
void FaultHypotheses::allow_for_scale() {
  const RadarSet present = evidence.present();
  if (evidence.disputed_scale() > 0.0 || std::popcount(present) != 2 ||
      (present & at_fault()) != 0) {
    return;
  }
  const RadarSet one = present & ~(present - 1U);
  const double a_mps = evidence.sum(one).solution().x();
  const double b_mps = evidence.sum(present & ~one).solution().x();
  const double scale = std::abs(2.0 * (a_mps - b_mps) / (a_mps + b_mps));
  if (scale <= kMaxDisputedScale) {
    evidence.allow_for_scale(scale);
    is_newly_disputed_ = true;
    unknown_epochs_ = 0;
  }
}

/// Deletes the data from before a radar is found at fault, because the fault may be new; keeps them
/// if they already show a cause. Data of a radar that looks sideways are always discarded: in a
/// turn it may seem to be late (the right one of 1094).
void FaultHypotheses::begin_search(std::size_t radar) {
  if (is_at_fault(radar)) {
    return;
  }
  const bool is_shown =
      contains(evidence.judged(), radar) &&
      std::max(causes_[radar].find().gain, causes_[radar].find_others_late().gain) >= kMinGain;
  if (!is_shown) {
    causes_[radar].clear();
  }
}

/// Compares each radar with the motion by the other believed radars. Returns those that could be
/// compared: nothing new is known of the rest.
RadarSet FaultHypotheses::search_causes(RadarSet believed) {
  RadarSet compared = 0;
  believed &= evidence.present();
  if (std::popcount(evidence.present()) > 2 &&
      evidence.sum(believed).chi_square() > kMaxChiSquareOfEpoch) {
    return compared;
  }
  for (std::size_t i = 0; i < causes_.size(); ++i) {
    const RadarSet others = believed & ~set_of(i);
    if (others != 0) {
      const MotionSums by_others = evidence.sum(others);
      causes_[i].add_motion(evidence.time_us(), by_others.solution(),
                            by_others.random_covariance());
      if (evidence.velocity(i)) {
        causes_[i].add_velocity(evidence.velocity(i)->mps, evidence.velocity(i)->covariance);
        compared |= set_of(i);
      }
    }
  }
  return compared;
}

/// Of two radars it is not known whose scale is wrong. Who is late is known: the other one would be
/// early, and no frame is received before it was measured. Who is upside down is known, unless
/// their axes are in line (healthy pairs gain 9.3 at most, 0103 backwards). The finding must last:
/// after a change of scale a radar seems to be late, by more each second.
void FaultHypotheses::note_finding_of_two(std::size_t radar,
                                          const FaultCauseSearch::Finding& finding) {
  const FaultCause& cause = finding.cause;
  const double yaw_rad = state_.mount(radar).yaw_rad;
  const bool is_in_line = any_of(evidence.present() & ~set_of(radar), [&](std::size_t other) {
    return std::abs(std::sin(yaw_rad - state_.mount(other).yaw_rad)) < kMinBetweenAxesRad;
  });
  const bool is_decisive =
      finding.is_clear &&
      ((cause.kind == FaultKind::late && finding.gain > kMinGainOfLateness) ||
       (cause.kind == FaultKind::upside_down && finding.gain > kMinGain && !is_in_line));
  const bool is_same = is_decisive && radar == of_two_.radar && cause.kind == of_two_.cause.kind &&
                       std::abs(cause.value - of_two_.cause.value) < kMaxChangeOfDelayS;
  of_two_ = {radar, cause, is_same ? of_two_.epochs + 1 : 0};
}

/// Two of three radars that are late alike convict the third when the vehicle brakes. Against them
/// it seems to be early, which no radar is.
void FaultHypotheses::convict_late_others() {
  if (std::popcount(evidence.present()) < 3) {
    return;
  }
  const RadarSet convicted = evidence.present() & at_fault() & ~convictions_.accused();
  const RadarSet early = filter(convicted, [&](std::size_t i) {
    const FaultCauseSearch::Finding found = causes_[i].find_others_late();
    return found.is_clear && found.gain > kMinGain;
  });
  if (early == 0) {
    return;
  }
  convict(evidence.present() & ~at_fault(), evidence.time_us());
  for_each(early, [&](std::size_t i) { causes_[i].clear(); });
  reverse(early);
}

/// Convicts a radar whose velocities one error explains, if the best error of every other radar
/// gains less than half as much.
void FaultHypotheses::convict_by_cause(RadarSet compared) {
  std::size_t guilty = 0;
  FaultCauseSearch::Finding best;
  double next = 0.5 * kMinGain;
  for_each(evidence.judged() & compared, [&](std::size_t i) {
    const FaultCauseSearch::Finding found = causes_[i].find();
    if (is_at_fault(i)) {
      if (found.gain > kMinGain && is_grave(found.cause)) {
        convictions_.convict(i, evidence.time_us());
      }
    } else if (found.gain > best.gain) {
      next = std::max(next, best.gain);
      best = found;
      guilty = i;
    } else {
      next = std::max(next, found.gain);
    }
  });
  const bool is_found = best.gain > 2.0 * next && is_grave(best.cause);
  note_finding_of_two(guilty, is_found ? best : FaultCauseSearch::Finding());
  if (is_found &&
      (std::popcount(evidence.present() & ~at_fault()) > 2 || of_two_.epochs >= kEpochsOfTwo)) {
    convictions_.convict(guilty, evidence.time_us());
  }
  const RadarSet aside = evidence.witnesses();
  for_each(aside, [&](std::size_t i) {
    if (any_of(aside, [&](std::size_t other) {
          return causes_[i].gain_at(other) > kMinGain && causes_[other].gain_at(i) > kMinGain;
        })) {
      convictions_.convict(i, evidence.time_us());
    }
  });
}

}  // namespace cremed
