// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/lone_mount.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Of the slip, in standard deviations of its prior. Single healthy radars reach 1.6 (17 on the six
/// drives); with a mount that is 3 degrees off it is 2.6 to 3.9.
constexpr double kMaxSlipSigmas = 2.2;
/// Scans in succession that show a turn. Of the same healthy radars' Doppler one scan contradicts
/// the state, 1.3 s after the start.
constexpr int kMinContradictions = 3;
/// Below it the velocity has no direction.
constexpr double kMinDrivingMps = 1.0;
/// Of a mount that turned, 6 degrees: learned to 0.5 degrees within a second of driving.
constexpr double kTurnedStdRad = 0.1;
/// Beyond it the error of the speed, 1 - cos of this, is more than a percent.
constexpr double kMaxLearnedRad = 0.15;
/// A jump by more is another fault: upside down in a tight turn.
constexpr double kMaxTurnRad = 0.6;
/// Two degrees: more than the error of a mount measured by hand.
constexpr double kMinNamedRad = 0.035;
/// Upside down the error is found this well (0.044 rad at most in 40 draws).
constexpr double kUpsideDownRad = 0.06;

}  // namespace

void LoneMount::restart() {
  forget_signs();
  for (std::size_t i = 0; i < before_restart_rad_.size(); ++i) {
    if (is_too_far(i)) {
      before_restart_rad_[i] = error_rad(i);
      state_.turn_mount_back(i);
    }
  }
}

void LoneMount::join(std::size_t radar) {
  forget_signs();
  before_restart_rad_[radar] = 0.0;
  if (is_too_far(radar)) {
    state_.turn_mount_back(radar);
  }
}

void LoneMount::forget_signs() {
  contradictions_ = 0;
  contradictions_by_positions_ = 0;
  turn_.reset();
}

void LoneMount::note_contradiction(std::size_t radar, const LinearMeasurement& doppler,
                                   const Innovation& innovation) {
  const double max_nis = state_.options().max_doppler_nis;
  const double speed_mps = state_.radar_velocity(radar).x();
  const bool is_lateral = innovation.nis_of_numbers.x() < 0.5 * max_nis &&
                          innovation.nis_of_numbers.y() > 0.5 * max_nis &&
                          std::abs(speed_mps) > kMinDrivingMps;
  contradictions_ = is_lateral ? contradictions_ + 1 : 0;
  if (contradictions_ == kMinContradictions) {
    contradictions_ = 0;
    turn_ = Turn{-doppler.residual.y() / speed_mps, state_.gaussian.mean(kYawRate), true};
  }
}

void LoneMount::note_agreement(std::size_t radar,
                               const std::optional<PositionFusion::YawRate>& by_positions) {
  contradictions_ = 0;
  if (!by_positions) {
    return;
  }
  const double speed_mps = state_.radar_velocity(radar).x();
  const bool contradicts = by_positions->contradicts_state && std::abs(speed_mps) > kMinDrivingMps;
  contradictions_by_positions_ = contradicts ? contradictions_by_positions_ + 1 : 0;
  if (contradictions_by_positions_ == kMinContradictions) {
    contradictions_by_positions_ = 0;
    turn_ = by_yaw_rate(radar, by_positions->radps);
  }
}

std::optional<LoneMount::Turn> LoneMount::take_turn(std::size_t radar) {
  const auto noted = std::exchange(turn_, std::nullopt);
  if (noted) {
    const bool is_possible = std::abs(error_rad(radar) + noted->yaw_rad) < kMaxTurnRad;
    return is_possible ? noted : std::nullopt;
  }
  const GaussianState& state = state_.gaussian;
  const double w = state.mean(kYawRate);
  const double speed_mps = std::abs(state.mean(kSpeed));
  const double least_radps = std::abs(w) - kGateSigmas * state.std(kYawRate);
  if (speed_mps * least_radps > kMaxAccelerationMps2) {
    return by_yaw_rate(radar, 0.0);
  }
  const double slip_rad = state.mean(kSlip);
  const double max_slip_rad = kMaxSlipSigmas * state_.options().slip_std_rad;
  if (state_.skid_variance() == 0.0 && std::abs(slip_rad) > max_slip_rad) {
    return Turn{-slip_rad, w, false};
  }
  return std::nullopt;
}

/// The turn that makes the yaw rate `radps`.
LoneMount::Turn LoneMount::by_yaw_rate(std::size_t radar, double radps) const {
  const double error_radps = state_.gaussian.mean(kYawRate) - radps;
  const double speed_mps = state_.radar_velocity(radar).x();
  return {-error_radps * state_.mount(radar).x_m / speed_mps, radps, true};
}

void LoneMount::learn(std::size_t radar, const Turn& turn) {
  GaussianState& state = state_.gaussian;
  const double std_radps = state_.options().settled_yaw_rate_std_radps;
  state_.turn_mount(radar, error_rad(radar) + turn.yaw_rad, kTurnedStdRad);
  if (turn.is_sudden) {
    state_.start_motion({state.mean(kSpeed), turn.yaw_rate_radps},
                        Eigen::Vector2d(state.variance(kSpeed), squared(std_radps)).asDiagonal());
  }
}

bool LoneMount::is_too_far(std::size_t radar) const {
  return state_.is_turned(radar) && (std::abs(error_rad(radar)) > kMaxLearnedRad ||
                                     may_be_upside_down(radar, error_rad(radar)));
}

FaultCause LoneMount::cause(std::size_t radar) const {
  const bool is_turned = state_.is_turned(radar);
  const double std_rad = is_turned ? state_.gaussian.std(state_.error(radar, kMountYaw)) : 0.0;
  const double value_rad = is_turned ? error_rad(radar) : before_restart_rad_[radar];
  const double least_rad = std::max(kMinNamedRad, kGateSigmas * std_rad);
  return std::abs(value_rad) > least_rad && !may_be_upside_down(radar, value_rad)
             ? FaultCause{FaultKind::mount_yaw, value_rad}
             : FaultCause();
}

/// Upside down the way ahead is as far to the other side of the radar's axis.
bool LoneMount::may_be_upside_down(std::size_t radar, double error_rad) const {
  const double if_so_rad = -2.0 * std::remainder(state_.mount(radar).yaw_rad, std::numbers::pi);
  return std::abs(if_so_rad) > kUpsideDownRad && std::abs(error_rad - if_so_rad) < kUpsideDownRad;
}

}  // namespace cremed
