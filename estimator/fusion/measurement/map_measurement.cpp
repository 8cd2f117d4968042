// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/map_measurement.hpp"

#include <Eigen/Geometry>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

using namespace state_layout;

namespace {

/// G with shifts along x taken as known.
Eigen::Matrix3d share_of(const MapMatch& match, std::size_t node) {
  Eigen::Matrix3d share = match.by_node[node];
  share.col(0).setZero();
  return share;
}

}  // namespace

TargetMap::NodePoses MapMeasurement::now_from_node() const {
  OdometryState::PoseJacobian jacobian;
  const Eigen::Vector3d now = state.pose_before(age_s, jacobian);
  TargetMap::NodePoses poses;
  for (std::size_t i = 0; i < kNodes; ++i) {
    poses[i] = relative_pose(now, state.node_pose(i));
  }
  return poses;
}

LinearMeasurement MapMeasurement::linearise(const MapMatch& match) const {
  const OdometryOptions& options = state.options();
  OdometryState::PoseJacobian by_motion;
  const Eigen::Vector3d now = state.pose_before(age_s, by_motion);
  Eigen::Matrix3d now_from_anchor = Eigen::Matrix3d::Identity();
  now_from_anchor.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-now.z()).toRotationMatrix();
  by_motion = (now_from_anchor * by_motion).eval();
  LinearMeasurement result;
  result.residual = match.correction.tail<2>();
  result.noise = options.position_noise_factor * match.covariance.bottomRightCorner<2, 2>();
  if (looks_across(state.mount(radar))) {
    result.noise *= options.position_noise_factor_across;
  }
  result.noise(0, 0) += squared(options.position_lateral_floor_m);
  result.noise(1, 1) += squared(options.position_yaw_floor_rad);
  for (int i = 0; i < kMotionStates; ++i) {
    result.depend_on(i, by_motion.col(i).tail<2>());
  }
  add_nodes(match, now_from_anchor, result);
  return result;
}

void MapMeasurement::add_nodes(const MapMatch& match, const Eigen::Matrix3d& now_from_anchor,
                               LinearMeasurement& measurement) const {
  const TargetMap::NodePoses nodes = now_from_node();
  const Eigen::Vector2d radar_m(state.mount(radar).x_m, state.mount(radar).y_m);
  Eigen::Vector3d by_mount_yaw = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_lateral = Eigen::Vector3d::Zero();
  Eigen::Vector3d by_yaw = Eigen::Vector3d::Zero();
  double turned_rad = 0.0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (!map.has(i)) {
      continue;
    }
    const Eigen::Matrix3d share = share_of(match, i);
    const Eigen::Vector3d& node = nodes[i];
    Eigen::Matrix3d by_node = now_from_anchor;
    by_node.topRightCorner<2, 1>() << node.y(), -node.x();
    by_node = (share * by_node).eval();
    for (int k = 0; k < kPose; ++k) {
      measurement.depend_on(state_layout::node(i) + k, -by_node.col(k).tail<2>());
    }
    const Eigen::Vector2d way_m = map.radar_m(i) - radar_m;
    by_mount_yaw += share * Eigen::Vector3d(-way_m.y(), way_m.x(), 0.0);
    by_lateral -= share.col(1) * node.x();
    by_yaw -= share.col(2) * node.x();
    turned_rad += share(2, 2) * node.z();
  }
  const auto depend_on = [&](int error, const Eigen::Vector3d& by) {
    measurement.depend_on(error, by.tail<2>());
    measurement.residual -= state.gaussian.mean(error) * by.tail<2>();
  };
  depend_on(state.error(radar, kMountYaw), by_mount_yaw);
  depend_on(state.error(radar, kLateralPerMetre), by_lateral);
  depend_on(state.error(radar, kYawPerMetre), by_yaw);
  depend_on(state.error(radar, kAzimuthScale), match.by_azimuth_scale);
  depend_on(kCommonAzimuthScale, match.by_azimuth_scale);
  measurement.noise(1, 1) += squared(state.options().position_yaw_per_turn * turned_rad);
}

}  // namespace cremed
