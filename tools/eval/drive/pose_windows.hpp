// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// Neighbouring windows begin this far apart.
inline constexpr std::int64_t kWindowStepUs = 500'000;

/// Poses of chained motions, interpolated linearly.
class ChainedPoses {
 public:
  explicit ChainedPoses(const std::vector<RecordedEstimate>& steps);

  /// Pose at `end_us` in the frame of that at `start_us`; nothing outside of the motions' time, in
  /// a gap or across one.
  [[nodiscard]] std::optional<Eigen::Vector3d> motion(std::int64_t start_us,
                                                      std::int64_t end_us) const;
  /// Of the last pose; nothing if there is none.
  [[nodiscard]] std::optional<std::int64_t> last_us() const {
    return utime_us_.empty() ? std::nullopt : std::optional(utime_us_.back());
  }

 private:
  struct Place {
    Pose2 pose;
    std::size_t gaps = 0;
  };

  void push(std::int64_t utime_us, const Place& place);
  [[nodiscard]] std::optional<Place> at(std::int64_t utime_us) const;

  std::vector<std::int64_t> utime_us_;
  std::vector<Place> places_;  // Gaps: those before the pose.
};

/// Errors at the ends of all windows of one length. NaN if there is none.
struct WindowErrors {
  std::size_t windows = 0;
  Eigen::Vector3d rmse = Eigen::Vector3d::Zero();  ///< (x_m, y_m, yaw_rad).
  double position_percent = 0.0;  ///< Mean distance from truth, in per cent of the true path.
};

/// Begin of the first window of a drive: one step after both truth and any of the sources have
/// begun.
std::int64_t first_window_us(const std::vector<RecordedOdometry>& sources,
                             const TrueTrajectory& truth);

/// Every window of that length, begun kWindowStepUs apart from `first_us` on, that both cover: the
/// poses without a gap, truth at both ends and without a gap of more than a second.
WindowErrors window_errors(const ChainedPoses& poses, const TrueTrajectory& truth,
                           std::int64_t first_us, std::int64_t length_us);

}  // namespace cremed
