// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "cremed/estimator/scan/pose2.hpp"

namespace cremed::test {

struct Polar {
  double range_m;
  double azimuth_rad;
};

/// The position of a static point in the radar's frame; independent of the simulator's code.
inline Polar seen_from(const Pose2& vehicle, const Pose2& mount, double x_m, double y_m) {
  const double dx = x_m - vehicle.x_m;
  const double dy = y_m - vehicle.y_m;
  const double forward_m = std::cos(vehicle.yaw_rad) * dx + std::sin(vehicle.yaw_rad) * dy;
  const double left_m = std::cos(vehicle.yaw_rad) * dy - std::sin(vehicle.yaw_rad) * dx;
  const double mx = forward_m - mount.x_m;
  const double my = left_m - mount.y_m;
  return {std::hypot(mx, my), std::remainder(std::atan2(my, mx) - mount.yaw_rad, 2.0 * M_PI)};
}

}  // namespace cremed::test
