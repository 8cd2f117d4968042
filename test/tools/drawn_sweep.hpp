// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/eval/drive/radar_sweep.hpp"
#include "tools/eval/plane_motion.hpp"

namespace cremed::test {

/// Static points, as seen by radars at the front and at both rear corners.
class DrawnWorld {
 public:
  DrawnWorld(unsigned seed, int points) : random_(seed) {
    std::uniform_real_distribution<double> along(-60.0, 200.0);
    std::uniform_real_distribution<double> across(-40.0, 40.0);
    for (int i = 0; i < points; ++i) {
      points_.emplace_back(along(random_), across(random_));
    }
  }

  /// From a pose in motion; every `moving_one_in`-th target moves.
  Sweep sweep(const Pose2& pose, const Eigen::Vector3d& twist, double position_std_m,
              std::size_t moving_one_in) {
    constexpr double kDopplerStdMps = 0.1;
    constexpr double kMaxRangeM = 50.0;
    static const std::array<Eigen::Vector2d, 3> kMounts{
        Eigen::Vector2d{3.4, 0.0}, Eigen::Vector2d{-0.6, 0.6}, Eigen::Vector2d{-0.6, -0.6}};
    std::normal_distribution<double> normal;
    Sweep result;
    for (const Eigen::Vector2d& point : points_) {
      const Eigen::Vector2d here =
          rotation_matrix(-pose.yaw_rad) * (point - Eigen::Vector2d(pose.x_m, pose.y_m));
      const Eigen::Vector2d& mount = kMounts[here.x() > 0.0 ? 0 : here.y() > 0.0 ? 1 : 2];
      if (here.norm() > kMaxRangeM) {
        continue;
      }
      const Eigen::Vector2d sight = (here - mount).normalized();
      SweepTarget target;
      target.position_m = here + position_std_m * Eigen::Vector2d(normal(random_), normal(random_));
      target.covariance_m2 = position_std_m * position_std_m * Eigen::Matrix2d::Identity();
      target.doppler_by_twist << -sight.x(), -sight.y(),
          sight.x() * mount.y() - sight.y() * mount.x();
      target.doppler_mps = target.doppler_by_twist * twist + kDopplerStdMps * normal(random_);
      if (result.targets.size() % moving_one_in == moving_one_in - 1) {
        target.doppler_mps += 3.0 + 2.0 * normal(random_);
      }
      result.targets.push_back(target);
    }
    return result;
  }

 private:
  std::mt19937 random_;
  std::vector<Eigen::Vector2d> points_;
};

}  // namespace cremed::test
