// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/map_measurement.hpp"

#include <cmath>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/fusion/tune.hpp"

namespace cremed {

using namespace state_layout;

MapMeasurement::NodePoses MapMeasurement::now_from_node() const {
  OdometryState::PoseJacobian jacobian;
  const Eigen::Vector3d now = state.pose_before(age_s, jacobian);
  NodePoses poses;
  for (std::size_t i = 0; i < kNodes; ++i) {
    poses[i] = relative_pose(now, state.node_pose(i));
  }
  return poses;
}

LinearMeasurement MapMeasurement::linearise(const MapMatch& match) const {
  const GaussianState& x = state.gaussian;
  const OdometryOptions& options = state.options();
  OdometryState::PoseJacobian by_motion;
  const Eigen::Vector3d now = state.pose_before(age_s, by_motion);
  const double c = std::cos(now.z());
  const double s = std::sin(now.z());
  Eigen::Matrix3d turn;
  turn << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  const Pose2& mount = state.mount(radar);
  const NodePoses nodes = now_from_node();

  Eigen::Vector3d by_mount_yaw = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_azimuth_scale = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_lateral = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_yaw = Eigen::Vector3d::Zero();
  double turned_rad = 0.0;
  LinearMeasurement result;
  const Eigen::Matrix<double, 3, kMotionStates> by_state = turn * by_motion;
  for (int i = 0; i < kMotionStates; ++i) {
    result.depend_on(i, by_state.col(i).tail<2>());
  }
  for (std::size_t i = 0; i < kNodes; ++i) {
    Eigen::Matrix3d share = match.by_node[i];
    if (share.isZero(0.0)) {
      continue;
    }
    static const bool kDropX = tune("dropx", 1) != 0;
    if (kDropX) share.col(0).setZero();
    const Eigen::Vector3d& node = nodes[i];
    Eigen::Matrix3d by_node = turn;
    by_node(0, 2) = node.y();
    by_node(1, 2) = -node.x();
    by_node = (share * by_node).eval();
    for (int k = 0; k < kPose; ++k) {
      result.depend_on(state_layout::node(i) + k, -by_node.col(k).tail<2>());
    }
    // The radar's place in the node's frame, seen from now, relative to its place now.
    const double cn = std::cos(node.z());
    const double sn = std::sin(node.z());
    const Eigen::Vector2d lever(
        node.x() + cn * mount.x_m - sn * mount.y_m - mount.x_m,
        node.y() + sn * mount.x_m + cn * mount.y_m - mount.y_m);
    by_mount_yaw += share * Eigen::Vector3d(-lever.y(), lever.x(), 0.0);
    by_azimuth_scale += share * (node.z() * Eigen::Vector3d(mount.y_m, -mount.x_m, 1.0));
    by_lateral += share * Eigen::Vector3d(0.0, -node.x(), 0.0);
    by_yaw += share * Eigen::Vector3d(0.0, 0.0, -node.x());
    turned_rad += share(2, 2) * node.z();
  }
  Eigen::Vector2d expected = Eigen::Vector2d::Zero();
  const auto depend = [&](int which, const Eigen::Vector3d& by) {
    result.depend_on(which, by.tail<2>());
    expected += x.mean(which) * by.tail<2>();
  };
  const auto error = [&](int which) { return state.error(radar, which); };
  depend(error(kMountYaw), by_mount_yaw);
  depend(error(kAzimuthScale), by_azimuth_scale);
  depend(kCommonAzimuthScale, by_azimuth_scale);
  depend(error(kLateralPerMetre), by_lateral);
  depend(error(kYawPerMetre), by_yaw);
  result.residual = match.correction.tail<2>() - expected;
  result.noise = options.position_noise_factor * match.covariance.bottomRightCorner<2, 2>();
  result.noise(0, 0) += squared(options.position_lateral_floor_m);
  result.noise(1, 1) += squared(options.position_yaw_floor_rad) +
                        squared(options.position_yaw_per_turn * turned_rad);
  return result;
}

}  // namespace cremed
