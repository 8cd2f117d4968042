// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/turned_mounts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Least distance from the axle. At 0.56 m and 12 m/s a yaw error of a degree looks like a turn of
/// 0.4 rad/s: learned mounts of nuScenes' rear radars put 6 % of the rows beyond 5 sigma, most of
/// which had been ambiguous.
constexpr double kMinLeverM = 1.0;
/// Of the slip, in standard deviations of its prior. Single healthy radars reach 1.6 (17 on the six
/// drives); with a mount that is 3 degrees off it is 2.6 to 3.9.
constexpr double kMaxSlipSigmas = 2.2;
/// The same by several radars: healthy ones reach 1.4 (those drives, also backwards), with mounts
/// that are all 1.5 degrees off 1.8 to 2.7.
constexpr double kMaxSlipSigmasOfAll = 1.6;
/// Scans in succession that show a turn. On those healthy drives one scan contradicts the state,
/// 1.3 s after a start.
constexpr int kMinSigns = 3;
/// Longest time between two of them: in a wrong turn the map has the targets of few scans.
constexpr double kMaxTimeBetweenS = 1.0;
/// Share of the limit of all numbers of an innovation by which one number contradicts.
constexpr double kShareOfOne = 0.5;
/// Doppler is rounded to 0.25 m/s: below it the direction is not known to 0.2 rad.
constexpr double kMinDrivingMps = 1.0;
/// For up to 0.6 s after a skid the slip of the state still exceeds the limit.
constexpr double kAfterSkidS = 1.0;
/// Of a mount that turned, 6 degrees: learned to 0.5 degrees within a second of driving.
constexpr double kTurnedStdRad = 0.1;
/// Of a common turn as the slip shows it, which its prior holds back.
constexpr double kTurnedAlikeStdRad = 0.03;
/// The error of the speed, 1 - cos of this, is 1.1 %.
constexpr double kMaxLearnedRad = 0.15;
/// Of a turn of all mounts alike, 7 degrees. 10 degrees seem to be 8 at first (1094).
constexpr double kMaxCommonRad = 0.12;
/// Speed of a radar across the vehicle over that along it: x of the mount over the radius of the
/// turn. 1.6 at the front of a bus of 12 m at full lock (8.7 over 5.5 m), 1.1 at most on a car.
constexpr double kMaxSidewaysShare = 1.6;
/// Twice the step to which Doppler is rounded.
constexpr double kMinSidewaysMps = 0.5;
/// A turn by more than 34 degrees is another fault: upside down in a tight bend the direction of
/// motion jumps like this.
constexpr double kMaxTurnRad = 0.6;
/// Two degrees: more than the error of a mount measured by hand.
constexpr double kMinNamedRad = 0.035;
/// 0.7 degrees: reached within a second of driving.
constexpr double kNamedStdRad = 0.012;
/// Of a radar whose axis is 3 degrees or more off the way: the error that shows upside down, and
/// its share that may be missing (0.044 of 0.136 rad at most in 40 draws).
constexpr double kLeastUpsideDownRad = 0.1;
constexpr double kUpsideDownShare = 0.33;

}  // namespace

bool TurnedMounts::Signs::add(std::size_t of_radar, std::int64_t stamp_us) {
  const bool goes_on = radar == of_radar && seconds_between(last_us, stamp_us) < kMaxTimeBetweenS;
  count = goes_on ? count + 1 : 1;
  radar = of_radar;
  last_us = stamp_us;
  const bool are_enough = count == kMinSigns;
  count = are_enough ? 0 : count;
  return are_enough;
}

bool TurnedMounts::judges(std::size_t radar) const {
  return std::abs(state_.mount(radar).x_m) > kMinLeverM;
}

void TurnedMounts::restart() {
  forget_signs();
  for (std::size_t i = 0; i < before_restart_rad_.size(); ++i) {
    if (is_too_far(i)) {
      before_restart_rad_[i] = error_rad(i);
      state_.turn_mount_back(i);
    }
  }
}

void TurnedMounts::settle() {
  has_settled_ = true;
  std::fill(before_restart_rad_.begin(), before_restart_rad_.end(), 0.0);
}

void TurnedMounts::join() {
  restart();
  std::fill(before_restart_rad_.begin(), before_restart_rad_.end(), 0.0);
}

void TurnedMounts::forget_signs() {
  by_doppler_ = Signs();
  by_positions_ = Signs();
  turn_.reset();
}

void TurnedMounts::note_contradiction(std::size_t radar, std::int64_t stamp_us,
                                      const LinearMeasurement& doppler,
                                      const Innovation& innovation) {
  const double max_nis = kShareOfOne * state_.options().max_doppler_nis;
  const double speed_mps = state_.radar_velocity(radar).x();
  const bool is_lateral = innovation.nis_of_numbers.x() < max_nis &&
                          innovation.nis_of_numbers.y() > max_nis &&
                          std::abs(speed_mps) > kMinDrivingMps;
  if (!is_lateral) {
    by_doppler_ = Signs();
  } else if (by_doppler_.add(radar, stamp_us)) {
    turn_ = Turn{-doppler.residual.y() / speed_mps, state_.gaussian.mean(kYawRate),
                 state_.options().settled_yaw_rate_std_radps, true};
  }
}

void TurnedMounts::note_agreement(std::size_t radar, std::int64_t stamp_us,
                                  const std::optional<PositionFusion::YawRate>& by_positions) {
  by_doppler_ = Signs();
  if (!by_positions) {
    return;
  }
  const double speed_mps = state_.radar_velocity(radar).x();
  if (!by_positions->contradicts_state || !(std::abs(speed_mps) > kMinDrivingMps)) {
    by_positions_ = Signs();
  } else if (by_positions_.add(radar, stamp_us)) {
    turn_ = by_yaw_rate(radar, by_positions->radps, state_.options().settled_yaw_rate_std_radps);
  }
}

void TurnedMounts::note_impossible_slip(const Eigen::Vector3d& motion) {
  if (!has_settled_) {
    turn_ = Turn{-motion.z(), motion.y(), state_.options().settled_yaw_rate_std_radps, true};
  }
}

std::optional<TurnedMounts::Turn> TurnedMounts::take_turn(std::size_t radar) {
  const auto noted = std::exchange(turn_, std::nullopt);
  const auto turn = noted ? noted : impossible_motion(radar);
  const bool is_possible = turn && std::abs(error_rad(radar) + turn->yaw_rad) < kMaxTurnRad;
  return is_possible ? turn : std::nullopt;
}

/// The turn without which the lateral acceleration is more than 1 g, or the slip impossible.
std::optional<TurnedMounts::Turn> TurnedMounts::impossible_motion(std::size_t radar) const {
  const GaussianState& state = state_.gaussian;
  const OdometryOptions& options = state_.options();
  const double w = state.mean(kYawRate);
  const double speed_mps = std::abs(state_.radar_velocity(radar).x());
  const double least_radps = std::abs(w) - kGateSigmas * state.std(kYawRate);
  if (speed_mps > kMinDrivingMps && speed_mps * least_radps > kMaxAccelerationMps2) {
    return by_yaw_rate(radar, 0.0, options.start_yaw_rate_std_radps);
  }
  return slips_by(kMaxSlipSigmas) ? std::optional(by_slip()) : std::nullopt;
}

std::optional<TurnedMounts::Turn> TurnedMounts::common_turn(
    RadarSet radars, const std::optional<Eigen::Vector3d>& motion) const {
  if (motion) {
    double learned_rad = 0.0;
    for_each(radars, [&](std::size_t i) { learned_rad += error_rad(i) - state_.turned_rad(i); });
    return Turn{-motion->z() - learned_rad / std::popcount(radars), motion->y(),
                state_.options().settled_yaw_rate_std_radps, true};
  }
  const GaussianState& state = state_.gaussian;
  const bool is_told = std::abs(state.mean(kSlip)) > kGateSigmas * state.std(kSlip) &&
                       state_.since_skid_s() > kAfterSkidS;
  return is_told && slips_by(kMaxSlipSigmasOfAll) ? std::optional(by_slip()) : std::nullopt;
}

/// Whether the slip is larger than this many standard deviations of its prior, without a skid.
bool TurnedMounts::slips_by(double sigmas) const {
  return std::abs(state_.gaussian.mean(kSlip)) > sigmas * state_.options().slip_std_rad &&
         state_.skid_variance() == 0.0;
}

/// The turn without which the vehicle does not slip.
TurnedMounts::Turn TurnedMounts::by_slip() const {
  const GaussianState& state = state_.gaussian;
  return {-state.mean(kSlip), state.mean(kYawRate), state.std(kYawRate), false};
}

/// The turn with which the yaw rate is `radps`.
TurnedMounts::Turn TurnedMounts::by_yaw_rate(std::size_t radar, double radps,
                                             double std_radps) const {
  const double error_radps = state_.gaussian.mean(kYawRate) - radps;
  const double speed_mps = state_.radar_velocity(radar).x();
  return {-error_radps * state_.mount(radar).x_m / speed_mps, radps, std_radps, true};
}

void TurnedMounts::learn(std::size_t radar, const Turn& turn) {
  state_.turn_mount(radar, error_rad(radar) + turn.yaw_rad, kTurnedStdRad);
  start_motion_if_sudden(turn);
}

bool TurnedMounts::learn_common(RadarSet radars, const Turn& turn) {
  const bool is_too_large = any_of(radars, [&](std::size_t radar) {
    const double turned_rad = error_rad(radar) + turn.yaw_rad;
    return std::abs(turned_rad) > kMaxCommonRad || may_be_upside_down(radar, turned_rad);
  });
  if (!is_too_large) {
    state_.turn_mounts(radars, turn.yaw_rad, kTurnedAlikeStdRad);
    start_motion_if_sudden(turn);
  }
  return !is_too_large;
}

void TurnedMounts::start_motion_if_sudden(const Turn& turn) {
  if (turn.is_sudden) {
    const GaussianState& state = state_.gaussian;
    state_.start_motion(
        {state.mean(kSpeed), turn.yaw_rate_radps},
        Eigen::Vector2d(state.variance(kSpeed), squared(turn.yaw_rate_std_radps)).asDiagonal());
  }
}

bool TurnedMounts::is_too_far(std::size_t radar) const {
  return state_.is_turned(radar) && (std::abs(error_rad(radar)) > kMaxLearnedRad ||
                                     may_be_upside_down(radar, error_rad(radar)));
}

bool TurnedMounts::moves_sideways(std::size_t radar) const {
  const Eigen::Vector2d velocity_mps = state_.radar_velocity(radar);
  const double std_mps = std::abs(state_.mount(radar).x_m) * state_.gaussian.std(kYawRate);
  return judges(radar) && std::abs(velocity_mps.y()) - kGateSigmas * std_mps >
                              kMaxSidewaysShare * std::abs(velocity_mps.x()) + kMinSidewaysMps;
}

FaultCause TurnedMounts::cause_of_sideways(std::size_t radar) const {
  return {FaultKind::mount_yaw, -std::atan2(way_[radar].y(), way_[radar].x())};
}

FaultCause TurnedMounts::cause(std::size_t radar) const {
  const bool is_turned = state_.is_turned(radar);
  const double value_rad = is_turned ? error_rad(radar) : before_restart_rad_[radar];
  const bool is_known =
      !is_turned || state_.gaussian.std(state_.error(radar, kMountYaw)) < kNamedStdRad;
  return is_known && std::abs(value_rad) > kMinNamedRad && !may_be_upside_down(radar, value_rad)
             ? FaultCause{FaultKind::mount_yaw, value_rad}
             : FaultCause();
}

/// Upside down the way ahead is as far to the other side of the radar's axis.
bool TurnedMounts::may_be_upside_down(std::size_t radar, double error_rad) const {
  const double if_so_rad = -2.0 * std::remainder(state_.mount(radar).yaw_rad, std::numbers::pi);
  return std::abs(if_so_rad) > kLeastUpsideDownRad &&
         std::abs(error_rad - if_so_rad) < kUpsideDownShare * std::abs(if_so_rad);
}

}  // namespace cremed
