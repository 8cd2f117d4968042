// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/simulate/vehicle_course.hpp"

namespace cremed {

/// A radar in the world at one moment.
struct RadarState {
  Pose2 pose;
  double x_mps = 0.0;  ///< Velocity of the radar over ground, in the world's axes.
  double y_mps = 0.0;
};

/// A point in the world, possibly moving.
struct WorldPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double x_mps = 0.0;
  double y_mps = 0.0;
};

/// Exact measurement of a point in the radar's frame: x forward, y left.
struct RadarView {
  double range_m = 0.0;
  double azimuth_rad = 0.0;
  double doppler_mps = 0.0;  ///< d(range)/dt
  /// Velocity over ground relative to that of the radar, across the line of sight, to the left.
  double across_mps = 0.0;
  double ground_doppler_mps = 0.0;  ///< The point's own contribution to Doppler: 0 if it is static.
};

RadarState radar_state(const VehicleState& vehicle, const Pose2& vehicle_from_radar);
RadarView view_of(const RadarState& radar, const WorldPoint& point);

}  // namespace cremed
