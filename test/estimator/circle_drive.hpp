// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cremed/estimator/scan/target_set.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::test {

using simulation::kPeriodS;

inline constexpr double kWorldM = 400.0;

/// A radar of a car that drives on a circle among static objects.
struct CircleDrive {
  double speed_mps = 10.0;
  double yaw_rate_radps = 0.0;
  double doppler_factor = 1.0;  ///< Factor on Doppler: 0 if stuck.
  double pace = 1.0;            ///< Rate of the stamps over time.
  int things = 2000;            ///< Objects on kWorldM x kWorldM.
  double post_spacing_m = 0.0;  ///< Of guard rails on both sides of the x axis; 0: none.
  double kept = 0.8;            ///< Share of objects seen in a scan.
  Pose2 mount{3.4, 0.0, 0.0};
};

/// What the radar sees, scan by scan.
class CircleView {
 public:
  /// Calls `add(targets, yaw_rate_radps, stamp_us)` for each scan.
  template <typename Add>
  void go_on(const CircleDrive& drive, double duration_s, const Add& add) {
    std::vector<Eigen::Vector2d> world = things(drive.things);
    for (double x_m = 0.0; drive.post_spacing_m > 0.0 && x_m < kWorldM;
         x_m += drive.post_spacing_m) {
      world.insert(world.end(), {{x_m, 5.0}, {x_m, -5.0}});
    }
    for (double t_s = 0.0; t_s < duration_s; t_s += kPeriodS) {
      yaw_ += drive.yaw_rate_radps * kPeriodS;
      place_ += drive.speed_mps * kPeriodS * Eigen::Vector2d(std::cos(yaw_), std::sin(yaw_));
      stamp_us_ += std::llround(drive.pace * kPeriodS * 1e6);
      add(seen(world, drive), drive.yaw_rate_radps, stamp_us_);
    }
  }

 private:
  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  double normal(double std) { return std::normal_distribution<double>(0.0, std)(random_); }

  static std::vector<Eigen::Vector2d> things(int count) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> anywhere(0.0, kWorldM);
    std::vector<Eigen::Vector2d> result;
    for (int i = 0; i < count; ++i) result.emplace_back(anywhere(random), anywhere(random));
    return result;
  }

  /// The world is periodic.
  static Eigen::Vector2d wrapped(const Eigen::Vector2d& way) {
    return {std::remainder(way.x(), kWorldM), std::remainder(way.y(), kWorldM)};
  }

  TargetSet seen(const std::vector<Eigen::Vector2d>& world, const CircleDrive& drive) {
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
      Detection detection;
      detection.range_m = p.norm() + normal(0.15);
      detection.azimuth_rad = std::atan2(p.y(), p.x()) + normal(0.008);
      detection.doppler_mps = -drive.doppler_factor * velocity.dot(p.normalized()) + normal(0.1);
      detection.range_std_m = 0.15;
      detection.azimuth_std_rad = 0.008;
      detection.doppler_std_mps = 0.1;
      const bool is_in_view = std::abs(detection.azimuth_rad) < 0.9 && p.norm() < 60.0;
      if (is_in_view && uniform(0.0, 1.0) < drive.kept && targets.size() < 120) {
        targets.add(detection, mount);
      }
    }
    return targets;
  }

  std::mt19937_64 random_{11};
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  double yaw_ = 0.0;
  std::int64_t stamp_us_ = 1'700'000'000'000'000;
};

}  // namespace cremed::test
