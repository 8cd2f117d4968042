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
};

/// Whether a radar with this mount looks sideways: 45 degrees or more off the direction of travel.
inline bool looks_across(const Pose2& vehicle_from_radar) {
  constexpr double kMaxSine = 0.7;
  return std::abs(std::sin(vehicle_from_radar.yaw_rad)) > kMaxSine;
}

}  // namespace cremed
