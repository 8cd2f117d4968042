// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "cremed/estimator/scan/pose2.hpp"
#include "daemon/output/odometry_sink.hpp"
#include "daemon/output/text_line.hpp"
#include "daemon/process/output_file.hpp"

namespace cremed {

/// A pose in TUM format: `seconds x y z qx qy qz qw` and a line end.
TextLine tum_line(std::int64_t utime_us, const Pose2& pose);

/// Trajectory of the odometry, or of one radar's chained ego-motions, in TUM format from the
/// origin. At a gap chained motions continue from their last pose as if the vehicle had not moved,
/// the odometry from where it predicts the vehicle; gaps() counts them.
class TumWriter final : public OdometrySink {
 public:
  /// Follows the radar of that index, or the odometry if there is none. Throws std::runtime_error
  /// if the file cannot be created.
  TumWriter(const std::string& path, std::optional<std::size_t> radar)
      : file_(path), radar_(radar) {}

  void on_motion(std::size_t radar, const EgoMotion& motion, std::int32_t solve_us) override;
  void on_odometry(const Odometry& odometry) override;
  [[nodiscard]] std::uint64_t failures() const override { return file_.failures(); }
  [[nodiscard]] std::string problem() const override { return file_.problem(); }
  [[nodiscard]] std::uint64_t gaps() const { return gaps_; }
  [[nodiscard]] bool is_of_radar() const { return radar_.has_value(); }

 private:
  void begin(std::int64_t utime_us);
  void write_pose(std::int64_t utime_us);

  OutputFile file_;
  std::optional<std::size_t> radar_;
  Eigen::Vector3d pose_ = Eigen::Vector3d::Zero();  // (x, y, yaw) since the start, m and rad.
  std::int64_t utime_us_ = 0;
  bool has_begun_ = false;
  std::uint64_t gaps_ = 0;
};

}  // namespace cremed
