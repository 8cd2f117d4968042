// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "cremed/estimator/fusion/map/map_registration.hpp"
#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// y and yaw of a scan registered against the radar's map.
struct MapMeasurement {
  using NodePoses = std::array<Eigen::Vector3d, state_layout::kNodes>;

  const OdometryState& state;
  std::size_t radar;
  double age_s;

  /// Pose of each node in the frame of the scan's predicted pose.
  [[nodiscard]] NodePoses now_from_node() const;
  [[nodiscard]] LinearMeasurement linearise(const MapMatch& match) const;
};

}  // namespace cremed
