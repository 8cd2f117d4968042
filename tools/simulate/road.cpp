// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/road.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cremed {
namespace {

constexpr double kSpacingM = 1.0;

Pose2 straight_on(const Pose2& from, double distance_m) {
  return {from.x_m + distance_m * std::cos(from.yaw_rad),
          from.y_m + distance_m * std::sin(from.yaw_rad), from.yaw_rad};
}

Pose2 between(const Pose2& a, const Pose2& b, double share) {
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m),
          a.yaw_rad + share * (b.yaw_rad - a.yaw_rad)};
}

}  // namespace

Road::Road(const VehicleCourse& course) : length_m_(course.steps().back().distance_m) {
  samples_.push_back(course.steps().front().pose);
  for (std::size_t i = 1; i < course.steps().size(); ++i) {
    const VehicleState& before = course.steps()[i - 1];
    const VehicleState& after = course.steps()[i];
    const double next_m = kSpacingM * static_cast<double>(samples_.size());
    if (after.distance_m < next_m) continue;
    const double share = (next_m - before.distance_m) / (after.distance_m - before.distance_m);
    samples_.push_back(between(before.pose, after.pose, share));
  }
  samples_.push_back(course.steps().back().pose);
}

RoadPoint Road::at(double distance_m) const {
  if (distance_m <= 0.0) return {straight_on(samples_.front(), distance_m), 0.0};
  if (distance_m >= length_m_) {
    return {straight_on(samples_.back(), distance_m - length_m_), 0.0};
  }
  const auto index =
      std::min(static_cast<std::size_t>(distance_m / kSpacingM), samples_.size() - 2);
  const double start_m = kSpacingM * static_cast<double>(index);
  const double gap_m = std::min(kSpacingM, length_m_ - start_m);
  const Pose2& a = samples_[index];
  const Pose2& b = samples_[index + 1];
  return {between(a, b, (distance_m - start_m) / gap_m), (b.yaw_rad - a.yaw_rad) / gap_m};
}

Pose2 beside(const RoadPoint& point, double left_m) {
  return {point.pose.x_m - left_m * std::sin(point.pose.yaw_rad),
          point.pose.y_m + left_m * std::cos(point.pose.yaw_rad), point.pose.yaw_rad};
}

}  // namespace cremed
