// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/simulate/vehicle_course.hpp"

namespace cremed {

/// A point of the road's centre line, which is the path of the vehicle's rear axle.
struct RoadPoint {
  Pose2 pose;
  double curvature_1pm = 0.0;
};

/// The vehicle's path by arc length, straight before its start and after its end.
class Road {
 public:
  explicit Road(const VehicleCourse& course);

  [[nodiscard]] RoadPoint at(double distance_m) const;
  [[nodiscard]] double length_m() const { return length_m_; }

 private:
  double length_m_ = 0.0;
  /// At intervals of kSpacingM from 0; the last is the end of the path.
  std::vector<Pose2> samples_;
};

/// The point `left_m` to the left of the centre line.
Pose2 beside(const RoadPoint& point, double left_m);

}  // namespace cremed
