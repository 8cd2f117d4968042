// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// Errors of a wheel reference, one sigma, constant over the compared interval.
struct WheelStd {
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

/// A second reference: the rear axle's speed along the vehicle's x axis from wheel encoders, and
/// the yaw rate of a gyro. It does not measure y.
class WheelReference {
 public:
  /// Reads CSV with the columns utime (us), speed_mps, yaw_rate_radps; throws std::runtime_error,
  /// also if the times do not increase.
  explicit WheelReference(std::istream& input, const WheelStd& std = {});

  /// Pose at `end_us` in the vehicle's frame at `start_us`, (x_m, y_m, yaw_rad): speed and yaw rate
  /// integrated by the trapezoid rule, y without slip. Nothing outside of the recorded time, or
  /// across a gap of it.
  [[nodiscard]] std::optional<Eigen::Vector3d> motion(std::int64_t start_us,
                                                      std::int64_t end_us) const {
    return dead_reckoning_.unbroken_motion(start_us, end_us);
  }
  /// (speed_mps, yaw_rate_radps) at a time, interpolated linearly.
  [[nodiscard]] std::optional<Eigen::Vector2d> rates(std::int64_t utime_us) const;
  [[nodiscard]] const WheelStd& std() const { return std_; }
  [[nodiscard]] const std::vector<TimeSpan>& gaps() const { return dead_reckoning_.gaps(); }
  [[nodiscard]] const std::vector<std::int64_t>& utime_us() const {
    return dead_reckoning_.utime_us();
  }

 private:
  WheelStd std_;
  std::vector<Eigen::Vector2d> rates_;
  TrueTrajectory dead_reckoning_;
};

}  // namespace cremed
