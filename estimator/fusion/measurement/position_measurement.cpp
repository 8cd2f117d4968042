// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/position_measurement.hpp"

#include <cmath>

#include "cremed/estimator/fusion/state/pose_chain.hpp"

namespace cremed {

using namespace state_layout;

double PositionMeasurement::at(int error) const {
  return state.gaussian.mean(state.error(radar, error));
}

double PositionMeasurement::yaw_scale() const {
  return 1.0 + at(kYawScale) + state.gaussian.mean(kCommonYawScale);
}

Eigen::Vector3d PositionMeasurement::keyframe_pose() const {
  return state.gaussian.mean().segment<kPose>(state.keyframe(radar, keyframe));
}

/// (z_y, z_psi) of a pose relative to the keyframe.
Eigen::Vector2d PositionMeasurement::apparent(const Eigen::Vector3d& relative) const {
  const double of_sensor_m = relative.x() - relative.z() * state.mount(radar).y_m;
  return {relative.y() - at(kMountYaw) * of_sensor_m + at(kLateralPerMetre) * relative.x(),
          relative.z() * yaw_scale() + at(kYawPerMetre) * relative.x()};
}

Eigen::Vector3d PositionMeasurement::expected_motion(const Eigen::Vector3d& scan_pose) const {
  const Eigen::Vector3d relative = relative_pose(keyframe_pose(), scan_pose);
  const Eigen::Vector2d seen = apparent(relative);
  return {relative.x(), seen.x(), seen.y()};
}

LinearMeasurement PositionMeasurement::linearise(const Eigen::Vector3d& motion) const {
  const int scan = state.scan(radar);
  const int from = state.keyframe(radar, keyframe);
  const Eigen::Vector3d pose = keyframe_pose();
  const Eigen::Vector3d relative = relative_pose(pose, state.gaussian.mean().segment<kPose>(scan));
  const double d = at(kMountYaw);
  const double lever_y = state.mount(radar).y_m;
  // Columns of d(z_y, z_psi) by dx, dy, dpsi.
  const Eigen::Vector2d by_x(at(kLateralPerMetre) - d, at(kYawPerMetre));
  const Eigen::Vector2d by_y(1.0, 0.0);
  const Eigen::Vector2d by_yaw(d * lever_y, yaw_scale());
  const double c = std::cos(pose.z());
  const double n = std::sin(pose.z());
  const auto error = [&](int which) { return state.error(radar, which); };
  LinearMeasurement result;
  result.residual = motion.tail<2>() - apparent(relative);
  result.depend_on(scan, c * by_x - n * by_y);
  result.depend_on(scan + 1, n * by_x + c * by_y);
  result.depend_on(scan + 2, by_yaw);
  result.depend_on(from, n * by_y - c * by_x);
  result.depend_on(from + 1, -n * by_x - c * by_y);
  result.depend_on(from + 2, relative.y() * by_x - relative.x() * by_y - by_yaw);
  result.depend_on(error(kMountYaw), {relative.z() * lever_y - relative.x(), 0.0});
  result.depend_on(error(kLateralPerMetre), {relative.x(), 0.0});
  result.depend_on(error(kYawPerMetre), {0.0, relative.x()});
  result.depend_on(error(kYawScale), {0.0, relative.z()});
  result.depend_on(kCommonYawScale, {0.0, relative.z()});
  return result;
}

}  // namespace cremed
