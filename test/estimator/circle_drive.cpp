// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/circle_drive.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace cremed::test {

void CircleView::go_on(const CircleDrive& drive, double duration_s, const Add& add) {
  std::vector<Eigen::Vector2d> world = things(drive.things);
  for (double x_m = 0.0; drive.post_spacing_m > 0.0 && x_m < kWorldM; x_m += drive.post_spacing_m) {
    world.insert(world.end(), {{x_m, 5.0}, {x_m, -5.0}});
  }
  for (double t_s = 0.0; t_s < duration_s; t_s += kPeriodS) {
    yaw_ += drive.yaw_rate_radps * kPeriodS;
    place_ += drive.speed_mps * kPeriodS * Eigen::Vector2d(std::cos(yaw_), std::sin(yaw_));
    stamp_us_ += std::llround(drive.pace * kPeriodS * 1e6);
    add(seen(world, drive), drive.yaw_rate_radps, stamp_us_);
  }
}

double CircleView::uniform(double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random_);
}

double CircleView::normal(double std) {
  return std::normal_distribution<double>(0.0, std)(random_);
}

std::vector<Eigen::Vector2d> CircleView::things(int count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(0.0, kWorldM);
  std::vector<Eigen::Vector2d> result;
  for (int i = 0; i < count; ++i) result.emplace_back(anywhere(random), anywhere(random));
  return result;
}

Eigen::Vector2d CircleView::wrapped(const Eigen::Vector2d& way) {
  return {std::remainder(way.x(), kWorldM), std::remainder(way.y(), kWorldM)};
}

TargetSet CircleView::seen(const std::vector<Eigen::Vector2d>& world, const CircleDrive& drive) {
  const Pose2& mount = drive.mount;
  const Eigen::Rotation2Dd to_vehicle(-yaw_);
  const Eigen::Rotation2Dd to_radar(-mount.yaw_rad);
  const Eigen::Vector2d sensor_m(mount.x_m, mount.y_m);
  const double w = drive.yaw_rate_radps;
  const Eigen::Vector2d velocity =
      to_radar * Eigen::Vector2d(drive.speed_mps - w * mount.y_m, w * mount.x_m);
  TargetSet targets;
  for (const Eigen::Vector2d& thing : world) {
    const Eigen::Vector2d p = to_radar * (to_vehicle * wrapped(thing - place_) - sensor_m);
    const double range_m = p.norm();
    if (range_m > 60.0) {
      continue;
    }
    Detection detection;
    detection.range_m = range_m + normal(0.15);
    detection.azimuth_rad = std::atan2(p.y(), p.x()) + normal(0.008);
    detection.doppler_mps = -drive.doppler_factor * velocity.dot(p.normalized()) + normal(0.1);
    detection.range_std_m = 0.15;
    detection.azimuth_std_rad = 0.008;
    detection.doppler_std_mps = 0.1;
    const bool is_in_view = std::abs(detection.azimuth_rad) < 0.9;
    if (is_in_view && uniform(0.0, 1.0) < drive.kept && targets.size() < 120) {
      targets.add(detection, mount);
    }
  }
  return targets;
}

}  // namespace cremed::test
