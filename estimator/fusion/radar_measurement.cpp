// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/radar_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/fusion/pose_chain.hpp"
#include "cremed/estimator/fusion/state_layout.hpp"

namespace cremed {

using namespace state_layout;

LinearMeasurement MeasurementModel::doppler(const DopplerVelocity& velocity, double age_s) const {
  const double dt_s = -std::max(age_s, 0.0);
  const double v = state.mean(kSpeed) + dt_s * state.mean(kAcceleration);
  const double w = state.mean(kYawRate) + dt_s * state.mean(kYawAcceleration);
  const double driving = std::min(1.0, std::abs(v) / kRollingMps);
  const double body = driving * std::exp(dt_s / options.body_velocity.time_s);
  const double lever_x = vehicle_from_radar.x_m + at(kLeverX);
  const double lever_y = vehicle_from_radar.y_m + at(kLeverY);
  const double forward = v + body * state.mean(kBodyVelocity) - w * lever_y;
  const double scale = 1.0 + at(kDopplerScale) + state.mean(kCommonScale);
  const double d = at(kMountYaw);
  const double s = state.mean(kSlip);
  const Eigen::Vector2d by_offset = driving * velocity.per_offset;
  const Eigen::Vector2d expected =
      Eigen::Vector2d(forward * scale, s * v + w * lever_x - d * forward) +
      driving * Eigen::Vector2d(at(kDopplerX), at(kDopplerY)) +
      (at(kOffset) + state.mean(kCommonOffset)) * by_offset;
  const Eigen::Vector2d by_speed(scale, s - d);
  const Eigen::Vector2d by_yaw_rate(-lever_y * scale, lever_x + d * lever_y);
  LinearMeasurement result;
  result.residual = velocity.velocity_mps - expected;
  result.depend_on(kSpeed, by_speed);
  result.depend_on(kAcceleration, dt_s * by_speed);
  result.depend_on(kYawRate, by_yaw_rate);
  result.depend_on(kYawAcceleration, dt_s * by_yaw_rate);
  result.depend_on(kSlip, {0.0, v});
  result.depend_on(kBodyVelocity, body * Eigen::Vector2d(scale, -d));
  result.depend_on(kCommonOffset, by_offset);
  result.depend_on(first + kMountYaw, {0.0, -forward});
  result.depend_on(kCommonScale, {forward, 0.0});
  result.depend_on(first + kDopplerScale, {forward, 0.0});
  result.depend_on(first + kDopplerX, {driving, 0.0});
  result.depend_on(first + kDopplerY, {0.0, driving});
  result.depend_on(first + kOffset, by_offset);
  result.depend_on(first + kLeverX, {0.0, w});
  result.depend_on(first + kLeverY, {-w * scale, d * w});
  result.noise = velocity.covariance;
  result.noise(0, 0) += options.velocity_floor_x_mps * options.velocity_floor_x_mps;
  result.noise(1, 1) += options.velocity_floor_y_mps * options.velocity_floor_y_mps;
  add_lateness(-dt_s, result);
  return result;
}

Eigen::Vector2d MeasurementModel::apparent(const Eigen::Vector3d& relative) const {
  const double scale = 1.0 + at(kYawScale) + state.mean(kCommonYawScale);
  return {relative.y() - at(kMountYaw) * (relative.x() - relative.z() * vehicle_from_radar.y_m) +
              at(kLateralPerMetre) * relative.x(),
          relative.z() * scale + at(kYawPerMetre) * relative.x()};
}

Eigen::Vector3d MeasurementModel::expected_motion(int keyframe, const Eigen::Vector3d& scan) const {
  const Eigen::Vector3d relative = relative_pose(state.mean().segment<3>(keyframe), scan);
  const Eigen::Vector2d seen = apparent(relative);
  return {relative.x(), seen.x(), seen.y()};
}

void MeasurementModel::add_lateness(double age_s, LinearMeasurement& measurement) const {
  const auto rate_variance = [age_s](const ForgettingNoise& noise) {
    return 2.0 * noise.std * noise.std / noise.time_s * age_s * age_s * age_s / 3.0;
  };
  const Eigen::Vector2d lever(-vehicle_from_radar.y_m, vehicle_from_radar.x_m);
  const double left = std::exp(-2.0 * age_s / options.body_velocity.time_s);
  measurement.noise(0, 0) += rate_variance(options.acceleration) +
                             options.body_velocity.std * options.body_velocity.std * (1.0 - left);
  measurement.noise += rate_variance(options.yaw_acceleration) * lever * lever.transpose();
}

LinearMeasurement MeasurementModel::position(int keyframe, int scan,
                                             const Eigen::Vector3d& motion) const {
  const Eigen::Vector3d from = state.mean().segment<3>(keyframe);
  const Eigen::Vector3d relative = relative_pose(from, state.mean().segment<3>(scan));
  const double d = at(kMountYaw);
  const double scale = 1.0 + at(kYawScale) + state.mean(kCommonYawScale);
  // Columns of d(z_y, z_psi) by dx, dy, dpsi.
  const Eigen::Vector2d by_x(at(kLateralPerMetre) - d, at(kYawPerMetre));
  const Eigen::Vector2d by_y(1.0, 0.0);
  const Eigen::Vector2d by_yaw(d * vehicle_from_radar.y_m, scale);
  const double c = std::cos(from.z());
  const double n = std::sin(from.z());
  LinearMeasurement result;
  result.residual = motion.tail<2>() - apparent(relative);
  result.depend_on(scan, c * by_x - n * by_y);
  result.depend_on(scan + 1, n * by_x + c * by_y);
  result.depend_on(scan + 2, by_yaw);
  result.depend_on(keyframe, n * by_y - c * by_x);
  result.depend_on(keyframe + 1, -n * by_x - c * by_y);
  result.depend_on(keyframe + 2, relative.y() * by_x - relative.x() * by_y - by_yaw);
  result.depend_on(first + kMountYaw, {relative.z() * vehicle_from_radar.y_m - relative.x(), 0.0});
  result.depend_on(first + kLateralPerMetre, {relative.x(), 0.0});
  result.depend_on(first + kYawPerMetre, {0.0, relative.x()});
  result.depend_on(first + kYawScale, {0.0, relative.z()});
  result.depend_on(kCommonYawScale, {0.0, relative.z()});
  return result;
}

}  // namespace cremed
