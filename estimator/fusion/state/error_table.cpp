// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/error_table.hpp"

#include <cmath>

#include "cremed/estimator/fusion/state/learned_errors.hpp"
#include "cremed/estimator/fusion/state/state_layout.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

using namespace state_layout;
using enum StateError::Reset;
using S = StateError;

double StateError::std_at(double speed_mps, double yaw_rate_radps) const {
  return process.std +
         (process.per_yaw_rate * std::abs(yaw_rate_radps) +
          process.per_lateral_acceleration * std::abs(speed_mps * yaw_rate_radps) +
          process.per_speed_across * (across * std::abs(speed_mps)) + process.if_across * across);
}

// Errors that are considered, not estimated, are hardly observable. They only seem to be, because
// each scan is linearised at another speed or yaw rate. As estimated states, scales of azimuths ran
// to -20 % in turns, and lever arms of 0.1 m to 3.4 m in an hour straight on. By Doppler alone the
// common Doppler scale drifted by 1 % in 15 minutes of a simulated town at a sigma of 0.2 %, and by
// y and yaw of positions too the speed became 0.3 % too small. At rest nothing observes mount yaws
// and Doppler scales, and all scans have the same map, whose noise they would learn: 0.4 degrees in
// three minutes. Doppler scales are also considered by all but x while only one radar is heard, or
// only ones 27 degrees or more off the axis (OdometryState): they are not separable from the speed.
// Two radars at 45 degrees learned 4.5 % in 20 minutes of starts and stops.

std::vector<StateError> common_errors(const OdometryOptions& o) {
  const OrnsteinUhlenbeck slip = bounded_walk(o.slip_std_rad, o.slip_walk);
  const double slip_per_acceleration_std = o.slip_per_lateral_acceleration_std;
  return {
      // Name, state, process, reset by, considered by.
      {"s slip, rad", kSlip, {slip.std, slip.time_s}, never},
      {"k slip per m/s^2, rad", kSlipPerAcceleration, {slip_per_acceleration_std}, never, S::kAll},
      {"m body, m/s", kBodyVelocity, {o.body_velocity.std, o.body_velocity.time_s}, scene},
      {"e_c rounding, m/s", kRounding, o.rounding, scene},
      {"e_m mixture, m/s", kMixture, o.mixture, scene},
      {"b_c Doppler scale", kCommonScale, {o.common_scale_std}, never, S::kAllButX},
      {"g_c azimuth scale", kCommonAzimuthScale, {o.common_azimuth_scale_std}, never, S::kAll},
      {"p_c x, m/m", kCommonXPerMetre, {o.common_x_per_metre_std}, never, S::kAll},
      {"r_c yaw, rad/m", kCommonYawPerMetre, {o.common_yaw_per_metre_std}, never, S::kAll},
  };
}

std::vector<StateError> radar_errors(const OdometryOptions& o, const Pose2& mount, int first) {
  const LearnedErrors prior = unlearned_errors(o, mount);
  const ErrorProcess scale{prior.doppler_scale.std, o.doppler_scale_time_s};
  ErrorProcess yaw{prior.mount_yaw_rad.std};
  yaw.time_s = bounded_walk(yaw.std, o.mount_yaw_walk).time_s;
  yaw.only_driving = true;  // At rest nothing turns the mount.
  std::vector<StateError> errors{
      {"u_x Doppler, m/s", kDopplerX, o.doppler_x, scene},
      {"u_y Doppler, m/s", kDopplerY, o.doppler_y, scene},
      {"o offset, m/s", kOffset, o.offset, scene},
      {"r yaw, rad/m", kYawPerMetre, o.yaw_per_metre, scene},
      {"q lateral, m/m", kLateralPerMetre, o.lateral_per_metre, scene},
      {"b Doppler scale", kDopplerScale, scale, doubt, S::kAtRest},
      {"d mount yaw, rad", kMountYaw, yaw, doubt, S::kAtRest},
      {"g azimuth scale", kAzimuthScale, {o.position_azimuth_scale_std}, never, S::kAll},
      {"e_x mount, m", kLeverX, {o.lever_std_m}, doubt, S::kAll},
      {"e_y mount, m", kLeverY, {o.lever_std_m}, doubt, S::kAll},
  };
  for (StateError& error : errors) {
    error.state += first;
    error.across = squared(std::sin(mount.yaw_rad));
  }
  return errors;
}

std::vector<StateError> signal_errors(const VehicleOptions& o, VehicleSignal signal, int first) {
  if (signal == VehicleSignal::speed) {
    return {{"b_v speed scale", first + kSpeedScale, {o.speed.scale_std, o.scale_time_s}, never}};
  }
  const ErrorProcess scale{o.yaw_rate.scale_std, o.scale_time_s};
  const ErrorProcess bias{.std = o.yaw_rate_bias_std_radps, .walk = o.yaw_rate_bias_walk};
  return {{"g_w yaw rate scale", first + kYawRateGain, scale, never, S::kPositions},
          {"h yaw rate bias, rad/s", first + kYawRateBias, bias, never}};
}

}  // namespace cremed
