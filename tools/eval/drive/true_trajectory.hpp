// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <istream>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/eval/drive/time_bracket.hpp"

namespace cremed {

/// Poses of the vehicle over time, such as true ones, interpolated linearly.
class TrueTrajectory {
 public:
  /// Reads CSV with the columns utime (us), x_m, y_m, yaw_rad; throws std::runtime_error, also if
  /// the times do not increase.
  explicit TrueTrajectory(std::istream& input);
  /// From poses and their times, which must increase; throws std::runtime_error.
  TrueTrajectory(std::vector<std::int64_t> utime_us, std::vector<Pose2> poses);
  /// With these gaps, whatever the distances of the poses.
  TrueTrajectory(std::vector<std::int64_t> utime_us, std::vector<Pose2> poses,
                 std::vector<TimeSpan> gaps);
  TrueTrajectory() = default;

  /// Pose at a time; nothing outside of the recorded time, or in a gap.
  [[nodiscard]] std::optional<Pose2> at(std::int64_t utime_us) const;
  /// Pose at `end_us` in the vehicle's frame at `start_us`: (x_m, y_m, yaw_rad).
  [[nodiscard]] std::optional<Eigen::Vector3d> motion(std::int64_t start_us,
                                                      std::int64_t end_us) const;
  /// The same; nothing across a gap either.
  [[nodiscard]] std::optional<Eigen::Vector3d> unbroken_motion(std::int64_t start_us,
                                                               std::int64_t end_us) const;
  /// Where poses are missing: as given, or neighbours farther apart than longest_step_us.
  [[nodiscard]] const std::vector<TimeSpan>& gaps() const { return gaps_; }
  /// Whether a gap is between these times, in part or all.
  [[nodiscard]] bool touches_gap(std::int64_t start_us, std::int64_t end_us) const;
  /// All recorded poses and their times.
  [[nodiscard]] const std::vector<Pose2>& poses() const { return poses_; }
  [[nodiscard]] const std::vector<std::int64_t>& utime_us() const { return utime_us_; }

 private:
  std::vector<std::int64_t> utime_us_;
  std::vector<Pose2> poses_;
  std::vector<TimeSpan> gaps_;
};

/// Pose `end` in the frame of pose `start`: (x_m, y_m, yaw_rad).
Eigen::Vector3d motion_between(const Pose2& start, const Pose2& end);
/// Inverse of it: the pose reached from `start` by `motion`.
Pose2 moved(const Pose2& start, const Eigen::Vector3d& motion);

}  // namespace cremed
