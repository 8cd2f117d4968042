// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <vector>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed::test {

/// Two scans without noise of the same landmarks, before and after `motion`.
struct ScanPair {
  TargetSet previous;
  TargetSet current;
};

inline Detection seen_from(const Pose2& pose, double x_m, double y_m, double dt_s) {
  const double dx = x_m - pose.x_m;
  const double dy = y_m - pose.y_m;
  Detection detection;
  detection.range_m = std::hypot(dx, dy);
  detection.azimuth_rad = std::atan2(dy, dx) - pose.yaw_rad;
  detection.range_std_m = 0.1;
  detection.azimuth_std_rad = 0.01;
  detection.doppler_std_mps = 0.1;
  const double c = std::cos(detection.azimuth_rad);
  const double s = std::sin(detection.azimuth_rad);
  detection.doppler_mps = -(pose.x_m * c + pose.y_m * s) / dt_s;
  return detection;
}

inline ScanPair scan_pair(const Pose2& motion, double dt_s) {
  static const std::vector<std::pair<double, double>> landmarks{
      {5.0, 1.0}, {9.0, -4.0}, {14.0, 6.0}, {20.0, -2.0}, {11.0, 3.0}, {7.0, 5.0}, {17.0, -8.0}};
  ScanPair pair;
  for (const auto& [x_m, y_m] : landmarks) {
    pair.previous.add(seen_from(Pose2{}, x_m, y_m, dt_s), Pose2{});
    pair.current.add(seen_from(motion, x_m, y_m, dt_s), Pose2{});
  }
  return pair;
}

}  // namespace cremed::test
