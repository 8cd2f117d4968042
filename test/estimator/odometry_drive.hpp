// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/odometry_filter.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::simulation {

/// A vehicle with radars that drives through static points, and its filter.
class OdometryDrive {
 public:
  static constexpr std::int64_t kPeriodUs = 75000;

  struct Radar {
    Pose2 mount;       ///< True mount,
    Pose2 configured;  ///< and the one in the filter's configuration.
    /// Velocity along x of all targets of this radar. At the vehicle's own speed it measures no
    /// motion.
    double world_mps = 0.0;
    double traffic_mps = 0.0;  ///< Velocity along x of three of four targets, with the world.
    bool is_silent = false;
    double doppler_scale = 1.0;
  };

  OdometryDrive(const std::vector<Pose2>& mounts, std::uint64_t seed,
                const OdometryOptions& options = {},
                const std::vector<std::optional<LearnedErrors>>& learned = {});

  /// Sets speed and yaw rate, and the speed of the rear axle to the left.
  void set_motion(double speed_mps, double yaw_rate_radps, double side_mps = 0.0) {
    speed_mps_ = speed_mps;
    yaw_rate_radps_ = yaw_rate_radps;
    side_mps_ = side_mps;
  }
  /// Leaves this share of the static points.
  void thin_out(double share) {
    points_.resize(static_cast<std::size_t>(share * static_cast<double>(points_.size())));
  }
  Radar& radar(std::size_t i) { return radars_[i]; }
  [[nodiscard]] OdometryFilter& filter() { return *filter_; }

  /// Drives on to the next scan of a radar that is not silent, and updates the filter.
  Odometry next();

  /// Drives for a time; returns the last odometry.
  Odometry drive(double time_s);

  void pass(std::int64_t time_us);

  /// The targets of a radar at the present pose.
  TargetSet see(std::size_t which);

  [[nodiscard]] std::int64_t stamp_us() const { return stamp_us_; }
  [[nodiscard]] const Eigen::Vector3d& pose() const { return pose_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] double yaw_rate_radps() const { return yaw_rate_radps_; }
  [[nodiscard]] double side_mps() const { return side_mps_; }

 private:
  Random random_;
  Points points_;
  std::vector<Radar> radars_;
  std::unique_ptr<OdometryFilter> filter_;
  double doppler_factor_ = 1.0;  // Learned by the filter.
  std::size_t turn_ = 0;
  Eigen::Vector3d pose_ = Eigen::Vector3d::Zero();
  double speed_mps_ = 8.0;
  double yaw_rate_radps_ = 0.0;
  double side_mps_ = 0.0;
  std::int64_t stamp_us_ = 1'000'000'000;
};

}  // namespace cremed::simulation
