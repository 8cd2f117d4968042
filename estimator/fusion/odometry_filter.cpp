// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/odometry_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"
#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// An error of scale that all radars share is found within this time of driving.
constexpr double kScaleFoundS = 1.0;
/// A smaller one is left to the filter, which estimates it with this sigma, and not named.
constexpr double kMinLearnedScale = 0.02;

}  // namespace

OdometryFilter::OdometryFilter(const OdometryOptions& options, std::vector<Pose2> mounts,
                               const std::vector<std::optional<LearnedErrors>>& learned)
    : state_(options, std::move(mounts), learned),
      consensus_(state_),
      faults_(state_),
      condition_(state_, consensus_, faults_),
      traffic_(state_, consensus_, faults_, condition_),
      side_slip_(state_),
      turned_mounts_(state_),
      majority_(state_, consensus_, condition_),
      positions_(state_, consensus_, faults_, condition_),
      output_(state_),
      vehicle_(state_, output_) {
  for (std::size_t i = 0; i < state_.radars(); ++i) {
    tracks_.push_back(std::make_unique<RadarTrack>(state_.options()));
  }
  state_.start();
}

Odometry OdometryFilter::update(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us,
                                bool is_trusted) {
  // 1. Which radars are believed.
  if (!is_trusted) {
    faults_.accuse(radar, stamp_us);
  }
  is_trusted = is_trusted && !faults_.is_at_fault(radar) && !faults_.is_unknown();
  const auto believed = faults_.take_correction();
  if (believed) {
    add_error_of_motion(*believed);
    follow_if_far(*believed, possible_speed_change_mps(stamp_us));
  }
  if (const auto scale = faults_.take_scale_in_dispute()) {
    allow_for_scale(*scale);
  }
  // 2. A start, after a gap or a loss.
  start_if_needed(stamp_us, is_trusted);
  bool is_signal_wrong = false;
  bool has_turned = false;
  if (is_usable(radar, targets, stamp_us)) {
    state_.hear(radar, stamp_us);
    // 3. Propagation to the scan (9), with what the vehicle's bus told until then (12).
    is_signal_wrong =
        vehicle_.use_until(stamp_us, condition_.is_settled() && !condition_.is_speed_unknown());
    output_.advance_to(stamp_us);
    state_.advance_errors(radar, tracks_[radar]->begin(stamp_us));
    set_trusted(radar, is_trusted);
    // 4. Velocity by Doppler (10), and 5. if that fits, motion by positions (11, 13).
    const bool is_used = use_doppler(radar, targets, stamp_us);
    const auto yaw_rate = is_used ? positions_.use(radar, targets, stamp_us) : std::nullopt;
    if (is_mount_judged(radar)) {
      if (const auto motion = faults_.motion_with_impossible_slip()) {
        turned_mounts_.note_impossible_slip(*motion);
      } else if (is_used) {
        turned_mounts_.note_agreement(radar, stamp_us, yaw_rate);
      }
      has_turned = learn_mount_if_turned(radar);
    } else if (!state_.is_witness(radar) && !state_.is_alone_ahead(radar)) {
      if (is_used) {
        turned_mounts_.join();
      }
      has_turned = learn_common_turn();
    }
    has_turned = learn_common_scale() || has_turned;
    if (is_sideways(radar)) {
      condition_.unsettle();
    }
  }
  // 6. The output. Its condition is set before the anchor is renewed, which ends a segment that may
  // have the error of a wrong radar.
  output_.add_error(traffic_.parked.take_way());
  Odometry odometry = output_.at_scan();
  Odometry result = with_condition(odometry);
  odometry.status = result.status;
  was_ok_ = was_ok_ || result.status == OdometryStatus::ok;
  traffic_.parked.add_output(odometry);
  const bool settles = condition_.settle();
  if (settles) {
    turned_mounts_.settle();
  }
  if (settles || believed || is_signal_wrong || has_turned) {
    output_.end_anchor();
  }
  return result;
}

std::optional<Odometry> OdometryFilter::predict_next(std::int64_t now_us) {
  if (state_.options().rate_hz == 0 || !has_started_) {
    return std::nullopt;
  }
  const auto odometry = output_.predict_next(now_us);
  return odometry ? std::optional(with_condition(*odometry)) : std::nullopt;
}

void OdometryFilter::compare(std::size_t radar, const EgoMotion& motion, bool is_trusted,
                             bool is_speed_undecided) {
  faults_.evidence.add_motion(radar, motion);
  faults_.note_speed_undecided(radar, is_speed_undecided);
  if (is_trusted && !faults_.is_at_fault(radar)) {
    vehicle_.compare(state_.mount(radar), motion);
  }
}

void OdometryFilter::forget() {
  faults_.clear();
  output_.leave_clock();
  state_.leave_clock();
  vehicle_.forget();
  has_started_ = false;
}

Odometry OdometryFilter::with_condition(Odometry odometry) const {
  traffic_.parked.widen(odometry);
  odometry.status = condition_.status(odometry);
  odometry.left_out = left_out();
  return odometry;
}

// Start.

void OdometryFilter::start_if_needed(std::int64_t stamp_us, bool is_trusted) {
  const double gap_s = seconds_between(state_.time_us(), stamp_us);
  const bool is_reversed = faults_.take_reversal();
  const bool has_stepped_back = faults_.take_step_back();
  const bool is_lost = (condition_.is_lost() && is_trusted && !traffic_.parked.is_parked() &&
                        gap_s > -state_.options().max_lateness_s) ||
                       is_reversed || has_stepped_back;
  if (has_started_ && (gap_s > state_.options().max_gap_s || is_lost)) {
    if (is_lost) {
      faults_.require_positions(majority_.step_mps());
    }
    // A late scan does not take back what was published.
    const std::int64_t from_us = std::max(stamp_us, state_.time_us());
    const bool is_contradicted = condition_.is_doubtful(state_.time_us()) ||
                                 faults_.at_fault() != 0 ||
                                 consensus_.contradicting(state_.time_us()) != 0;
    restart(from_us, is_reversed || has_stepped_back || is_contradicted
                         ? OdometryOutput::Gap::nothing
                         : OdometryOutput::Gap::speed);
  } else if (!has_started_) {
    restart(stamp_us, OdometryOutput::Gap::speed);
  }
}

void OdometryFilter::restart(std::int64_t stamp_us, OdometryOutput::Gap gap) {
  for (const auto& track : tracks_) {
    track->clear();
  }
  positions_.clear();
  consensus_.clear();
  output_.restart(stamp_us, has_started_ ? condition_.unused_s(stamp_us) : 0.0, gap);
  condition_.start();
  majority_.clear();
  traffic_.parked.clear();
  side_slip_.clear();
  faults_.forget_skid();
  turned_mounts_.restart();
  has_started_ = true;
  was_ok_ = false;
}

bool OdometryFilter::is_usable(std::size_t radar, const TargetSet& targets,
                               std::int64_t stamp_us) const {
  return seconds_between(stamp_us, state_.time_us()) <= state_.options().max_lateness_s &&
         tracks_[radar]->is_in_order(stamp_us) && targets.is_finite();
}

/// Widens the errors of a radar that is no longer trusted: they may be wrong.
void OdometryFilter::set_trusted(std::size_t radar, bool is_trusted) {
  RadarTrust& trust = consensus_[radar];
  if (trust.is_trusted && !is_trusted) {
    state_.widen_errors(radar);
    trust.doppler_noise.clear();
  }
  trust.is_trusted = is_trusted;
}

/// Whether TurnedMounts judges the radar: no other that looks ahead or back is heard, be it
/// believed or not.
bool OdometryFilter::is_mount_judged(std::size_t radar) const {
  return !faults_.is_at_fault(radar) && !looks_across(state_.mount(radar)) &&
         state_.is_alone_ahead(radar) && turned_mounts_.judges(radar);
}

/// A radar, the only one or one of those that look sideways, that moves as no vehicle does.
bool OdometryFilter::is_sideways(std::size_t radar) const {
  return state_.is_alone_ahead(radar) && turned_mounts_.moves_sideways(radar);
}

/// The mount of the lone radar turned: the pose and the slip may have that error.
bool OdometryFilter::learn_mount_if_turned(std::size_t radar) {
  const auto turn = turned_mounts_.take_turn(radar);
  const bool has_turned = turn && !majority_.has_stepped();
  if (has_turned) {
    const double v = state_.gaussian.mean(kSpeed);
    const double w = turn->yaw_rate_radps;
    add_error_of_motion({v, w, -state_.gaussian.mean(kSlipPerAcceleration) * v * w});
    turned_mounts_.learn(radar, *turn);
    if (turn->is_sudden) {
      positions_.clear();
      vehicle_.restart_errors();
      faults_.pause();
    }
  }
  if (turned_mounts_.is_too_far(radar)) {
    condition_.unsettle();
  }
  return has_turned;
}

/// Learns a turn that the mounts of all radars share; true if there was one. The pose since the
/// anchor gets its error.
bool OdometryFilter::learn_common_turn() {
  const RadarSet used = state_.heard(state_.time_us()) & state_.ahead() & ~faults_.at_fault();
  const auto& motion = faults_.common_motion();
  const bool may_be_told = condition_.is_settled() && !faults_.is_unknown() &&
                           !faults_.is_skidding() && !majority_.has_stepped();
  if (std::popcount(used) < 2 || (!motion && !may_be_told)) {
    return false;
  }
  const auto turn = turned_mounts_.common_turn(used, motion);
  if (!turn) {
    return false;
  }
  if (!turned_mounts_.learn_common(used, *turn)) {
    if (!motion) {
      condition_.unsettle();
    }
    return false;
  }
  const double way_m = state_.gaussian.mean(kSpeed) * output_.anchor_age_s();
  state_.gaussian.add_variance(kY, squared(way_m * turn->yaw_rad));
  faults_.pause();
  return true;
}

/// Learns an error of scale that all radars in use share; true if there was one.
bool OdometryFilter::learn_common_scale() {
  const auto& scale = faults_.common_scale();
  if (!scale || new_doppler_factor_ != 1.0 || majority_.has_stepped() ||
      traffic_.parked.is_in_doubt()) {
    return false;
  }
  double in_all = doppler_factor_ * scale->factor;
  in_all = std::abs(in_all - 1.0) < kMinLearnedScale ? 1.0 : in_all;
  new_doppler_factor_ = in_all / doppler_factor_;
  doppler_factor_ = in_all;
  const double estimated = 1.0 + state_.gaussian.mean(kCommonScale);
  const double error_mps = (estimated * new_doppler_factor_ - 1.0) * state_.gaussian.mean(kSpeed);
  state_.start_scale(error_mps);
  state_.gaussian.add_variance(kX, squared(error_mps * output_.anchor_age_s()));
  output_.add_error_of_way(error_mps * std::max(kScaleFoundS - output_.anchor_age_s(), 0.0));
  positions_.clear();
  vehicle_.restart_errors();
  faults_.note_scale_learned();
  return true;
}

/// Adds this error of scale to the Doppler of each judged radar, the speed, and the way since the
/// anchor.
void OdometryFilter::allow_for_scale(double scale) {
  for_each(faults_.evidence.judged(), [&](std::size_t i) { state_.widen_scale(i, scale); });
  const double speed_mps = scale * state_.gaussian.mean(kSpeed);
  const double way_m = speed_mps * output_.anchor_age_s();
  state_.gaussian.add_variance(kSpeed, squared(speed_mps));
  state_.gaussian.add_variance(kX, squared(way_m));
}

/// The speed by the only radar jumped, as no vehicle moves. The state may have followed it. Before
/// it is settled the jump only makes the start wait (DopplerScale::is_open).
void OdometryFilter::reject_jump(std::size_t radar, const SpeedJump::Jump& jump) {
  const double change_mps = jump.change_mps();
  if (!condition_.is_settled() || !is_only_one_ahead(radar, jump.stamp_us) ||
      !majority_.note_jump(change_mps)) {
    return;
  }
  GaussianState& state = state_.gaussian;
  const double v = state.mean(kSpeed);
  if (std::abs(v - jump.after_mps) < std::abs(v - jump.before_mps)) {
    const double std_mps = std::min(std::abs(change_mps), state_.options().settled_speed_std_mps);
    state_.start_motion({v - change_mps, state.mean(kYawRate)},
                        Eigen::Vector2d(squared(std_mps), state.variance(kYawRate)).asDiagonal());
    state.add_variance(kX, squared(change_mps * seconds_between(jump.stamp_us, state_.time_us())));
  }
  condition_.doubt();
}

/// A radar was found at fault: the pose since the anchor and the slip may have its error.
/// Adds to their variance the difference of the state to `believed`, (v, w, slip) by the others.
void OdometryFilter::add_error_of_motion(const Eigen::Vector3d& believed) {
  GaussianState& state = state_.gaussian;
  const double since_s = output_.anchor_age_s();
  const double v = state.mean(kSpeed);
  const double w = state.mean(kYawRate);
  const double way_m = (v - believed.x()) * since_s;
  const double turn_rad = (w - believed.y()) * since_s;
  const double slip_rad =
      state.mean(kSlip) - state.mean(kSlipPerAcceleration) * v * w - believed.z();
  state.add_variance(kX, squared(way_m));
  state.add_variance(
      kY, squared(believed.x() * since_s) * (squared(slip_rad) + squared(0.5 * turn_rad)));
  state.add_variance(kYaw, squared(turn_rad));
  state.add_variance(kSlip, squared(slip_rad));
  state_.forget_faults();
}

/// If the state is far from `believed` it followed a radar at fault, and so did the errors of the
/// others and the maps: they start anew. Not if all was well before a step: the believed radars may
/// be wrong as well.
void OdometryFilter::follow_if_far(const Eigen::Vector3d& believed, double possible_change_mps) {
  const OdometryOptions& options = state_.options();
  const double change_mps = std::abs(state_.gaussian.mean(kSpeed) - believed.x());
  const double change_radps = std::abs(state_.gaussian.mean(kYawRate) - believed.y());
  const bool is_far = change_mps > options.settled_speed_std_mps ||
                      change_radps > options.settled_yaw_rate_std_radps;
  const bool is_step = was_ok_ && change_mps > possible_change_mps;
  if (!is_far || is_step || majority_.has_stepped()) {
    return;
  }
  for (std::size_t i = 0; i < state_.radars(); ++i) {
    state_.widen_errors(i);
  }
  state_.start_motion(believed.head<2>(),
                      Eigen::Vector2d(squared(options.settled_speed_std_mps),
                                      squared(options.settled_yaw_rate_std_radps))
                          .asDiagonal());
  vehicle_.restart_errors();
  positions_.clear();
}

/// Radars that are not believed: at fault, side radars that contradict, all that are judged if it
/// is not known which are at fault, or the only one if its mount is too far off.
RadarSet OdometryFilter::left_out() const {
  const RadarSet turned = filter(first_radars(state_.radars()), [&](std::size_t i) {
    return turned_mounts_.is_left_out(i) || is_sideways(i);
  });
  return turned | consensus_.at_fault() |
         (faults_.is_unknown() ? faults_.evidence.judged() : faults_.at_fault());
}

// Doppler.

/// True if the scan's Doppler was used.
bool OdometryFilter::use_doppler(std::size_t radar, const TargetSet& targets,
                                 std::int64_t stamp_us) {
  const auto expected =
      condition_.is_speed_unknown() ? std::nullopt : std::optional(state_.radar_velocity(radar));
  const auto scan = tracks_[radar]->velocity(targets, expected);
  if (!scan) {
    return false;
  }
  turned_mounts_.note_velocity(radar, scan->velocity.velocity_mps);
  if (consensus_[radar].is_trusted && !state_.is_witness(radar) && !traffic_.parked.is_parked()) {
    state_.add_excess(scan->excess_m2ps2);
  }
  using Seen = TrafficDoubt::Seen;
  const Seen seen =
      traffic_.judge(radar, targets, scan->velocity, stamp_us, possible_speed_change_mps(stamp_us));
  if (seen == Seen::traffic) {
    condition_.doubt();
    return false;
  }
  if (seen == Seen::road) {
    faults_.add_velocity(radar, stamp_us, scan->velocity);
    if (const auto jump = faults_.evidence.take_lone_jump()) {
      reject_jump(radar, *jump);
    }
  }
  if (faults_.is_unknown()) {
    condition_.doubt();
  }
  if (condition_.is_speed_unknown() && consensus_[radar].is_trusted && !majority_.has_stepped() &&
      (condition_.used_scans() == 0 || condition_.is_lost())) {
    // The speed, and so the distance, was unknown since the start or the loss: restart here.
    const double gap_s = condition_.used_scans() == 0 ? 0.0 : condition_.unused_s(state_.time_us());
    output_.restart(state_.time_us(), gap_s, OdometryOutput::Gap::speed);
    positions_.clear();
    state_.gaussian.assume(kSpeed, scan->velocity.velocity_mps.x());
  }
  return take_doppler(radar, targets, *scan, stamp_us);
}

bool OdometryFilter::take_doppler(std::size_t radar, const TargetSet& targets,
                                  const ScanVelocity& scan, std::int64_t stamp_us) {
  RadarTrust& trust = consensus_[radar];
  const double age_s = seconds_between(stamp_us, state_.time_us());
  LinearMeasurement measurement = DopplerMeasurement{state_, radar, age_s}.linearise(scan.velocity);
  measurement.noise *= trust.doppler_noise.value();
  if (state_.is_witness(radar)) {
    measurement.noise *= state_.options().doppler_noise_factor_across;
  }
  Innovation innovation = state_.gaussian.innovate(measurement);
  if (trust.is_trusted && !state_.is_witness(radar) && condition_.is_settled()) {
    if (const auto slip_rad = side_slip_.add(radar, stamp_us, measurement, innovation)) {
      state_.add_skid(*slip_rad);
      innovation = state_.gaussian.innovate(measurement);
    }
  }
  if (may_be_jolt(radar, stamp_us, measurement.residual.x(), innovation)) {
    state_.add_jolt(condition_.unused_s(state_.time_us()));
    innovation = state_.gaussian.innovate(measurement);
  }
  const bool is_expected = innovation.nis <= state_.options().max_doppler_nis;
  trust.doppler.add(stamp_us, 0.5 * innovation.nis);
  if (trust.judge(stamp_us, scan.velocity, is_expected) && state_.is_witness(radar)) {
    state_.widen_errors(radar);
  }
  const bool is_used = !consensus_.is_left_out(radar) && trust.is_trusted;
  if (is_used) {
    trust.doppler_noise.add(0.5 * innovation.nis);
  }
  if (!is_expected) {
    if (is_used && is_mount_judged(radar) && (condition_.is_settled() || state_.is_turned(radar))) {
      turned_mounts_.note_contradiction(radar, stamp_us, measurement, innovation);
    }
    trust.contradicts_positions = positions_.confirm_state(radar, targets, age_s);
    answer_contradiction(radar, stamp_us, measurement.residual.x(), innovation);
    return false;
  }
  trust.contradicts_positions = false;
  if (majority_.is_after_step(radar, scan.velocity.velocity_mps)) {
    condition_.doubt();
    return false;
  }
  if (is_used) {
    state_.update(innovation);
    if (turned_mounts_.is_too_far(radar)) {
      return is_used;  // Only to see whether it turns back.
    }
    output_.add_radar(radar);
    if (!state_.is_witness(radar)) {
      condition_.use_scan(scan.is_clear);
    }
  }
  return is_used;
}

/// Whether a vehicle that began to brake or accelerate hard since the last scan explains one whose
/// speed contradicts the state, of the only radar ahead that can tell (otherwise:
/// MajorityFollower). Only the first contradiction: a step that no vehicle can make does not become
/// one by waiting.
bool OdometryFilter::may_be_jolt(std::size_t radar, std::int64_t stamp_us, double change_mps,
                                 const Innovation& innovation) const {
  const bool contradicts = innovation.nis > state_.options().max_doppler_nis &&
                           innovation.nis_of_numbers.x() > innovation.nis_of_numbers.y();
  return contradicts && consensus_[radar].has_agreed() && condition_.is_settled() &&
         is_only_one_ahead(radar, stamp_us) &&
         condition_.unused_s(stamp_us) <= state_.options().predicted_s &&
         std::abs(change_mps) <= possible_speed_change_mps(stamp_us);
}

/// Whether in the last 0.3 s no other trusted radar that looks ahead or back was heard.
bool OdometryFilter::is_only_one_ahead(std::size_t radar, std::int64_t stamp_us) const {
  return consensus_[radar].is_trusted && !looks_across(state_.mount(radar)) &&
         consensus_.is_only_voter(radar, stamp_us);
}

/// A scan contradicts the state, its speed by `change_mps`. The state follows if most radars agree
/// on another velocity. The only radar ahead is not followed: a change of its speed that no vehicle
/// can make is noted as a step.
void OdometryFilter::answer_contradiction(std::size_t radar, std::int64_t stamp_us,
                                          double change_mps, const Innovation& innovation) {
  const double possible_mps = possible_speed_change_mps(stamp_us);
  const auto majority = consensus_.contradicting_majority(stamp_us);
  if (!majority && is_only_one_ahead(radar, stamp_us)) {
    if (innovation.nis_of_numbers.x() > state_.options().max_doppler_nis) {
      majority_.note_step(change_mps, possible_mps);
    }
    if (majority_.has_stepped()) {
      condition_.doubt();
    }
  }
  const auto change = majority ? majority_.follow(*majority, stamp_us, possible_mps) : std::nullopt;
  if (!change) {
    return;
  }
  vehicle_.restart_errors();
  const double learned_mps = kMinLearnedScale * std::abs(state_.gaussian.mean(kSpeed));
  if (std::abs(change->x()) > state_.options().static_doppler_mps ||
      (doppler_factor_ != 1.0 && std::abs(change->x()) > learned_mps)) {
    // The maps hold targets that seemed at rest at the wrong speed; or the learned error of scale
    // has ended, which new maps tell.
    positions_.clear();
  }
}

/// Largest change of the speed that a vehicle can make since the last scan that was used.
double OdometryFilter::possible_speed_change_mps(std::int64_t stamp_us) const {
  const double since_s = std::max(0.0, condition_.unused_s(stamp_us));
  return kGateSigmas * state_.gaussian.std(kSpeed) + kMaxAccelerationMps2 * since_s;
}

// Reports.

std::vector<std::optional<LearnedErrors>> OdometryFilter::learned() const {
  std::vector<std::optional<LearnedErrors>> result(tracks_.size());
  const std::vector<LearnedErrors> learned = state_.learned();
  bool is_any_turned = false;  // Errors are relative to the mean of all radars.
  for (std::size_t i = 0; i < learned.size(); ++i) {
    is_any_turned = is_any_turned || state_.is_turned(i);
  }
  for (std::size_t i = 0; i < learned.size(); ++i) {
    if (!contains(left_out(), i) && !is_any_turned) {
      result[i] = learned[i];
    }
  }
  return result;
}

FaultCause OdometryFilter::cause(std::size_t radar) const {
  FaultCause cause = faults_.cause(radar);
  if (cause.kind == FaultKind::scale) {
    cause.value *= doppler_factor_;
  }
  if (cause.kind == FaultKind::unknown) {
    cause =
        is_sideways(radar) ? turned_mounts_.cause_of_sideways(radar) : turned_mounts_.cause(radar);
  }
  const double scale = doppler_factor_ / (1.0 + state_.gaussian.mean(kCommonScale));
  const bool is_scale = cause.kind == FaultKind::unknown && doppler_factor_ != 1.0 &&
                        std::abs(scale - 1.0) > kMinLearnedScale &&
                        contains(state_.ahead() & ~left_out(), radar);
  return is_scale ? FaultCause{FaultKind::scale, scale} : cause;
}

RadarReport OdometryFilter::report(std::size_t radar) const {
  const RadarTrust& trust = consensus_[radar];
  const GaussianState& state = state_.gaussian;
  const int mount_yaw = state_.error(radar, kMountYaw);
  const int doppler_scale = state_.error(radar, kDopplerScale);
  const bool is_left_out = contains(left_out(), radar);
  return {is_left_out,
          cause(radar),
          trust.doppler.mean(),
          trust.lateral.mean(),
          trust.yaw.mean(),
          trust.doppler_noise.value(),
          trust.position_noise.value(),
          state.mean(mount_yaw),
          state.std(mount_yaw),
          state.mean(doppler_scale),
          state.std(doppler_scale),
          positions_.counters(radar)};
}

}  // namespace cremed
