// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "cremed/estimator/fusion/map/map_registration.hpp"
#include "cremed/estimator/fusion/map/target_map.hpp"
#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// x, y and yaw of a scan registered against the radar's map. With the share G_k of node k in the
/// information (MapMatch::by_node) and its pose (x_k, y_k, psi_k) in the frame of the pose at the
/// scan, (11) of the README:
///
///     z = sum_k G_k (true pose of the scan relative to node k - the predicted one)
///         + sum_k G_k (d Jl_k - (p p_c, q, r + r_c) x_k) + h (g + g_c)
///
/// d mount yaw, l_k the radar's way from now to node k and J its turn by 90 degrees, p p_c error of
/// x over distance with p = (1 - x_share) / x_share, q lateral and r yaw error over distance, g
/// scale error of azimuths (p_c, r_c, g_c common to all radars) with its effect h
/// (MapMatch::by_azimuth_scale). The effects of x on y and yaw, and of these on x, are neglected in
/// G_k. Doppler measures x far better in a single scan; over seconds x shows the scale of Doppler.
struct MapMeasurement {
  const OdometryState& state;
  const TargetMap& map;
  std::size_t radar;
  double age_s;  ///< Of the scan, relative to the state.

  /// Pose of each node in the frame of the scan's predicted pose.
  [[nodiscard]] TargetMap::NodePoses now_from_node() const;
  /// `has_x`: whether x is measured.
  [[nodiscard]] LinearMeasurement linearise(const MapMatch& match, bool has_x) const;

 private:
  void add_nodes(const MapMatch& match, const Eigen::Matrix3d& now_from_anchor,
                 LinearMeasurement& measurement) const;
};

}  // namespace cremed
