// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/cost/doppler_rounding.hpp"
#include "cremed/estimator/cost/driving_share.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

using namespace state_layout;

LinearMeasurement DopplerMeasurement::linearise(const DopplerVelocity& velocity) const {
  const GaussianState& x = state.gaussian;
  const OdometryOptions& options = state.options();
  const int first = state.error(radar, 0);
  const auto at = [&](int error) { return x.mean(first + error); };
  const double dt_s = -std::max(age_s, 0.0);
  const double v = x.mean(kSpeed) + dt_s * x.mean(kAcceleration);
  const double w = x.mean(kYawRate) + dt_s * x.mean(kYawAcceleration);
  const double driving = driving_share(v);
  const double rounding = rounding_share(v);
  const double body = driving * std::exp(dt_s / options.body_velocity.time_s);
  const double lever_x = state.mount(radar).x_m + at(kLeverX);
  const double lever_y = state.mount(radar).y_m + at(kLeverY);
  const double forward = v + body * x.mean(kBodyVelocity) - w * lever_y;
  const double scale = 1.0 + at(kDopplerScale) + x.mean(kCommonScale);
  const double d = at(kMountYaw);
  const double k = x.mean(kSlipPerAcceleration);
  const double s = x.mean(kSlip) - k * v * w;
  const Eigen::Vector2d by_offset = driving * velocity.per_offset;
  const Eigen::Vector2d expected =
      Eigen::Vector2d(forward * scale, s * v + w * lever_x - d * forward) +
      driving * Eigen::Vector2d(at(kDopplerX), at(kDopplerY)) + at(kOffset) * by_offset +
      Eigen::Vector2d(rounding * x.mean(kRounding) + x.mean(kMixture), 0.0);
  const Eigen::Vector2d by_speed(scale, s - d - k * v * w);
  const Eigen::Vector2d by_yaw_rate(-lever_y * scale, lever_x + d * lever_y - k * v * v);
  LinearMeasurement result;
  result.residual.head<2>() = velocity.velocity_mps - expected;
  result.depend_on(kSpeed, by_speed);
  result.depend_on(kAcceleration, dt_s * by_speed);
  result.depend_on(kYawRate, by_yaw_rate);
  result.depend_on(kYawAcceleration, dt_s * by_yaw_rate);
  result.depend_on(kSlip, 0.0, v);
  result.depend_on(kSlipPerAcceleration, 0.0, -v * v * w);
  result.depend_on(kBodyVelocity, body * Eigen::Vector2d(scale, -d));
  result.depend_on(kRounding, rounding, 0.0);
  result.depend_on(kMixture, 1.0, 0.0);
  result.depend_on(first + kMountYaw, 0.0, -forward);
  result.depend_on(kCommonScale, forward, 0.0);
  result.depend_on(first + kDopplerScale, forward, 0.0);
  result.depend_on(first + kDopplerX, driving, 0.0);
  result.depend_on(first + kDopplerY, 0.0, driving);
  result.depend_on(first + kOffset, by_offset);
  result.depend_on(first + kLeverX, 0.0, w);
  result.depend_on(first + kLeverY, -w * scale, d * w);
  // In each scan of a lateral radar passing objects make this difference: its noise factors have
  // it.
  result.noise.topLeftCorner<2, 2>() =
      looks_across(state.mount(radar)) ? velocity.covariance : velocity.covariance_in_traffic();
  result.noise(0, 0) += squared(options.velocity_floor_x_mps);
  result.noise(1, 1) += squared(options.velocity_floor_y_mps);
  add_lateness(result);
  return result;
}

void DopplerMeasurement::add_lateness(LinearMeasurement& measurement) const {
  const OdometryOptions& options = state.options();
  const double late_s = std::max(age_s, 0.0);
  const Eigen::Vector2d lever(-state.mount(radar).y_m, state.mount(radar).x_m);
  const double left = std::exp(-2.0 * late_s / options.body_velocity.time_s);
  measurement.noise(0, 0) += rate_variance(options.acceleration, late_s) +
                             squared(options.body_velocity.std) * (1.0 - left);
  const double v = state.gaussian.mean(kSpeed);
  const OrnsteinUhlenbeck yaw = yaw_acceleration_at(v, options, state.skid_variance());
  measurement.noise(1, 1) += squared(v) * skid_noise(state.skid_variance(), late_s);
  measurement.noise.topLeftCorner<2, 2>() += rate_variance(yaw, late_s) * lever * lever.transpose();
}

}  // namespace cremed
