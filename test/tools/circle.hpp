// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/eval/drive/wheel_reference.hpp"
#include "tools/simulate/random.hpp"

namespace cremed::test {

/// Drives a circle at constant speed and yaw rate, without slip: all figures are known.
struct Circle {
  double speed_mps = 8.0;
  double yaw_rate_radps = 0.1;

  /// Exact motion over a time, seen from its begin.
  [[nodiscard]] Eigen::Vector3d motion(double time_s) const {
    const double yaw_rad = yaw_rate_radps * time_s;
    const double radius_m = speed_mps / yaw_rate_radps;
    return {radius_m * std::sin(yaw_rad), radius_m * (1.0 - std::cos(yaw_rad)), yaw_rad};
  }

  /// Its poses at each multiple of `step_us`, with independent errors of these standard deviations.
  [[nodiscard]] TrueTrajectory truth(std::int64_t step_us, std::size_t steps,
                                     const Eigen::Vector3d& noise, Random& random) const {
    std::vector<std::int64_t> utime_us;
    std::vector<Pose2> poses;
    for (std::size_t i = 0; i <= steps; ++i) {
      utime_us.push_back(static_cast<std::int64_t>(i) * step_us);
      const Pose2 pose =
          moved({100.0, -50.0, 2.0}, motion(static_cast<double>(utime_us.back()) * 1e-6));
      poses.push_back(moved(pose, {noise.x() * random.normal(), noise.y() * random.normal(),
                                   noise.z() * random.normal()}));
    }
    return {std::move(utime_us), std::move(poses)};
  }

  /// Wheels every 10 ms with constant errors.
  [[nodiscard]] std::string wheels_csv(double seconds, const WheelStd& error = {}) const {
    std::string csv = "utime,speed_mps,yaw_rate_radps\n";
    for (std::int64_t utime_us = 0; utime_us <= std::llround(1e6 * seconds); utime_us += 10'000) {
      std::array<char, 96> line{};
      std::snprintf(line.data(), line.size(), "%lld,%.12g,%.12g\n",
                    static_cast<long long>(utime_us), speed_mps + error.speed_mps,
                    yaw_rate_radps + error.yaw_rate_radps);
      csv += line.data();
    }
    return csv;
  }

  /// Consecutive estimates, each with an independent error of this covariance.
  [[nodiscard]] std::vector<RecordedEstimate> estimates(std::int64_t step_us, std::size_t steps,
                                                        const Eigen::Matrix3d& covariance,
                                                        Random& random) const {
    const Eigen::Matrix3d root = covariance.llt().matrixL();
    std::vector<RecordedEstimate> result;
    for (std::size_t i = 0; i < steps; ++i) {
      const auto start_us = static_cast<std::int64_t>(i) * step_us;
      const Eigen::Vector3d normal{random.normal(), random.normal(), random.normal()};
      result.push_back({start_us, start_us + step_us,
                        motion(static_cast<double>(step_us) * 1e-6) + root * normal, covariance});
    }
    return result;
  }
};

inline constexpr std::int64_t kStepUs = 100'000;

inline TrueTrajectory exact_truth(const Circle& circle, std::size_t steps) {
  Random unused(0, 0);
  return circle.truth(kStepUs, steps, Eigen::Vector3d::Zero(), unused);
}

/// Without the poses from `first` to `last`.
inline TrueTrajectory with_gap(const TrueTrajectory& truth, std::size_t first, std::size_t last) {
  std::vector<std::int64_t> utime_us;
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < truth.poses().size(); ++i) {
    if (i < first || i > last) {
      utime_us.push_back(truth.utime_us()[i]);
      poses.push_back(truth.poses()[i]);
    }
  }
  return {std::move(utime_us), std::move(poses)};
}

inline WheelReference read_wheels(const std::string& csv, const WheelStd& std = {}) {
  std::istringstream input(csv);
  return WheelReference(input, std);
}

}  // namespace cremed::test
