// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace cremed {

/// A pose in the plane: x forward, y left, yaw counter-clockwise. `a_from_b` maps points of b to a.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;

  bool operator==(const Pose2&) const = default;
};

/// Sine of the angle between a radar's axis and the direction of travel, forward or back.
inline double sine_off_travel(const Pose2& vehicle_from_radar) {
  return std::abs(std::sin(vehicle_from_radar.yaw_rad));
}

/// Whether a radar with this mount looks sideways: 55 degrees or more off the direction of travel.
/// Corner radars, at 45 degrees, do not: with a limit there a fault of one of four was not told.
inline bool looks_across(const Pose2& vehicle_from_radar) {
  constexpr double kMaxSine = 0.82;
  return sine_off_travel(vehicle_from_radar) > kMaxSine;
}

}  // namespace cremed
