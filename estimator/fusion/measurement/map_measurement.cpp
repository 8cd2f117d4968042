// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/map_measurement.hpp"

#include <Eigen/Geometry>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

using namespace state_layout;

namespace {

/// G without the effects of x on y and yaw and of these on x.
Eigen::Matrix3d share_of(const MapMatch& match, std::size_t node) {
  const Eigen::Matrix3d& by_node = match.by_node[node];
  Eigen::Matrix3d share = Eigen::Matrix3d::Zero();
  share(0, 0) = by_node(0, 0);
  share.bottomRightCorner<2, 2>() = by_node.bottomRightCorner<2, 2>();
  return share;
}

void remove_x(LinearMeasurement& measurement) {
  measurement.residual.x() = 0.0;
  measurement.noise(0, 0) = 1.0;
  for (LinearMeasurement::Column& column : measurement.jacobian) {
    column.x() = 0.0;
  }
}

}  // namespace

TargetMap::NodePoses MapMeasurement::now_from_node() const {
  const Eigen::Vector3d now = state.pose_before(age_s).pose;
  TargetMap::NodePoses poses;
  for (std::size_t i = 0; i < kNodes; ++i) {
    poses[i] = relative_pose(now, state.node_pose(i));
  }
  return poses;
}

LinearMeasurement MapMeasurement::linearise(const MapMatch& match, bool has_x) const {
  const OdometryOptions& options = state.options();
  const auto [now, anchor_by_motion] = state.pose_before(age_s);
  Eigen::Matrix3d now_from_anchor = Eigen::Matrix3d::Identity();
  now_from_anchor.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(-now.z()).toRotationMatrix();
  const auto by_motion = (now_from_anchor * anchor_by_motion).eval();
  LinearMeasurement result;
  result.residual = match.correction;
  result.residual.x() /= match.x_share;
  result.noise.bottomRightCorner<2, 2>() =
      options.position_noise_factor * match.covariance.bottomRightCorner<2, 2>();
  result.noise(0, 0) =
      options.position_noise_factor * match.covariance(0, 0) / squared(match.x_share) +
      squared(options.position_lateral_floor_m);
  result.noise(1, 1) += squared(options.position_lateral_floor_m);
  result.noise(2, 2) += squared(options.position_yaw_floor_rad);
  for (int i = 0; i < kMotionStates; ++i) {
    result.depend_on(i, by_motion.col(i));
  }
  add_nodes(match, now_from_anchor, result);
  if (!has_x) {
    remove_x(result);
  }
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
  double way_m = 0.0;
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
      measurement.depend_on(state_layout::node(i) + k, -by_node.col(k));
    }
    const Eigen::Vector2d radar_way_m = map.radar_m(i) - radar_m;
    by_mount_yaw += share * Eigen::Vector3d(-radar_way_m.y(), radar_way_m.x(), 0.0);
    by_lateral -= share.col(1) * node.x();
    by_yaw -= share.col(2) * node.x();
    turned_rad += share(2, 2) * node.z();
    way_m += share(0, 0) * node.x();
  }
  const auto depend_on = [&](int error, const Eigen::Vector3d& by) {
    measurement.depend_on(error, by);
    measurement.residual -= state.gaussian.mean(error) * by;
  };
  depend_on(state.error(radar, kMountYaw), by_mount_yaw);
  depend_on(state.error(radar, kLateralPerMetre), by_lateral);
  depend_on(state.error(radar, kYawPerMetre), by_yaw);
  depend_on(kCommonYawPerMetre, by_yaw);
  depend_on(state.error(radar, kAzimuthScale), match.by_azimuth_scale);
  depend_on(kCommonAzimuthScale, match.by_azimuth_scale);
  const double by_prior = (1.0 - match.x_share) / match.x_share;
  depend_on(kCommonXPerMetre, Eigen::Vector3d(-by_prior * way_m, 0.0, 0.0));
  measurement.noise(0, 0) += squared(state.options().position_x_per_metre * way_m);
  measurement.noise(2, 2) += squared(state.options().position_yaw_per_turn * turned_rad);
}

}  // namespace cremed
