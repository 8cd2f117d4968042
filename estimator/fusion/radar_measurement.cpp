// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/fusion/radar_measurement.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/fusion/state_layout.hpp"
#include "estimator/rotation.hpp"

namespace cremed {

using namespace state_layout;

Eigen::Vector3d relative_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector2d moved = Rotation(-a.z()) * (b - a).head<2>();
  return {moved.x(), moved.y(), b.z() - a.z()};
}

Eigen::Vector3d composed_pose(const Eigen::Vector3d& a, const Eigen::Vector3d& relative) {
  const Eigen::Vector2d moved = Rotation(a.z()) * relative.head<2>();
  return {a.x() + moved.x(), a.y() + moved.y(), a.z() + relative.z()};
}

LinearMeasurement RadarModel::doppler(const DopplerVelocity& velocity, double age_s) const {
  const double dt_s = -std::max(age_s, 0.0);
  const double v = state.mean(kSpeed) + dt_s * state.mean(kAcceleration);
  const double w = state.mean(kYawRate) + dt_s * state.mean(kYawAcceleration);
  const double driving = std::min(1.0, std::abs(v));
  const double body = driving * std::exp(dt_s / options.body_velocity.time_s);
  const double forward = v + body * state.mean(kBodyVelocity) - w * vehicle_from_radar.y_m;
  const double scale = 1.0 + at(kDopplerScale);
  const double d = at(kMountYaw);
  const double s = state.mean(kSlip);
  const Eigen::Vector2d by_offset = driving * velocity.per_offset;
  const Eigen::Vector2d expected =
      Eigen::Vector2d(forward * scale, s * v + w * vehicle_from_radar.x_m - d * forward) +
      driving * Eigen::Vector2d(at(kDopplerX), at(kDopplerY)) +
      (at(kOffset) + state.mean(kCommonOffset)) * by_offset;
  const Eigen::Vector2d by_speed(scale, s - d);
  const Eigen::Vector2d by_yaw_rate(-vehicle_from_radar.y_m * scale,
                                    vehicle_from_radar.x_m + d * vehicle_from_radar.y_m);
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
  result.depend_on(first + kDopplerScale, {forward, 0.0});
  result.depend_on(first + kDopplerX, {driving, 0.0});
  result.depend_on(first + kDopplerY, {0.0, driving});
  result.depend_on(first + kOffset, by_offset);
  result.noise = velocity.covariance;
  result.noise(0, 0) += options.velocity_floor_x_mps * options.velocity_floor_x_mps;
  result.noise(1, 1) += options.velocity_floor_y_mps * options.velocity_floor_y_mps;
  return result;
}

Eigen::Vector2d RadarModel::apparent(const Eigen::Vector3d& relative) const {
  const double scale = 1.0 + at(kYawScale) + state.mean(kCommonYawScale);
  return {relative.y() - at(kMountYaw) * (relative.x() - relative.z() * vehicle_from_radar.y_m) +
              at(kLateralPerMetre) * relative.x(),
          relative.z() * scale + at(kYawPerMetre) * relative.x()};
}

Eigen::Vector3d RadarModel::expected_motion(int keyframe, const Eigen::Vector3d& scan) const {
  const Eigen::Vector3d relative = relative_pose(state.mean().segment<3>(keyframe), scan);
  const Eigen::Vector2d seen = apparent(relative);
  return {relative.x(), seen.x(), seen.y()};
}

LinearMeasurement RadarModel::position(int keyframe, int scan,
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
