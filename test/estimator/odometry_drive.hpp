// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "cremed/estimator/fusion/odometry_filter.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed::simulation {

inline bool is_good(const Odometry& odometry) {
  return odometry.status == OdometryStatus::ok || odometry.status == OdometryStatus::standing_still;
}

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
    bool is_silent = false;
    double doppler_scale = 1.0;
  };

  OdometryDrive(const std::vector<Pose2>& mounts, std::uint64_t seed,
                const OdometryOptions& options = {},
                const std::vector<std::optional<LearnedErrors>>& learned = {})
      : random_(seed) {
    std::vector<OdometryRadar> radars;
    for (const Pose2& mount : mounts) {
      radars_.push_back({mount, mount});
      const std::size_t i = radars.size();
      radars.push_back({mount, i < learned.size() ? learned[i] : std::nullopt});
    }
    filter_ = std::make_unique<OdometryFilter>(options, radars);
    points_ = scatter(random_, 2500, 3.0, 250.0, numeric::radians(180.0), 0.5);
  }

  /// Sets speed and yaw rate.
  void set_motion(double speed_mps, double yaw_rate_radps) {
    speed_mps_ = speed_mps;
    yaw_rate_radps_ = yaw_rate_radps;
  }
  Radar& radar(std::size_t i) { return radars_[i]; }
  [[nodiscard]] OdometryFilter& filter() { return *filter_; }

  /// Drives on to the next scan of a radar that is not silent, and updates the filter.
  Odometry next() {
    do {
      pass(kPeriodUs / static_cast<std::int64_t>(radars_.size()));
      turn_ = (turn_ + 1) % radars_.size();
    } while (radars_[turn_].is_silent);
    return filter_->update(turn_, see(turn_), stamp_us_);
  }

  /// Drives for a time; returns the last odometry.
  Odometry drive(double time_s) {
    Odometry odometry;
    const std::int64_t end_us = stamp_us_ + static_cast<std::int64_t>(time_s * 1e6);
    while (stamp_us_ < end_us) {
      odometry = next();
    }
    return odometry;
  }

  void pass(std::int64_t time_us) {
    constexpr std::int64_t kStepUs = 1000;
    for (std::int64_t left_us = time_us; left_us > 0; left_us -= kStepUs) {
      const double dt_s = static_cast<double>(std::min(left_us, kStepUs)) * 1e-6;
      const double yaw_rad = yaw_rate_radps_ * dt_s;
      pose_ = composed_pose(pose_, {speed_mps_ * dt_s * std::cos(0.5 * yaw_rad),
                                    speed_mps_ * dt_s * std::sin(0.5 * yaw_rad), yaw_rad});
    }
    stamp_us_ += time_us;
  }

  /// The targets of a radar at the present pose.
  TargetSet see(std::size_t which) {
    const Radar& radar = radars_[which];
    const Eigen::Vector3d velocity(speed_mps_ - radar.world_mps, 0.0, yaw_rate_radps_);
    Detections detections;
    for (const Eigen::Vector2d& point : points_) {
      const Detection detection =
          observe(seen_from(pose_, point), velocity, radar.mount, {0.1, 0.008, 0.1});
      if (std::abs(detection.azimuth_rad) < numeric::radians(60.0) && detection.range_m < 50.0 &&
          detections.size() < 100) {
        detections.push_back(detection);
      }
    }
    perturb(detections, random_);
    for (Detection& detection : detections) {
      detection.doppler_mps *= radar.doppler_scale;
    }
    return targets(detections, radar.configured);
  }

  [[nodiscard]] std::int64_t stamp_us() const { return stamp_us_; }
  [[nodiscard]] const Eigen::Vector3d& pose() const { return pose_; }
  [[nodiscard]] double speed_mps() const { return speed_mps_; }
  [[nodiscard]] double yaw_rate_radps() const { return yaw_rate_radps_; }

 private:
  Random random_;
  Points points_;
  std::vector<Radar> radars_;
  std::unique_ptr<OdometryFilter> filter_;
  std::size_t turn_ = 0;
  Eigen::Vector3d pose_ = Eigen::Vector3d::Zero();
  double speed_mps_ = 8.0;
  double yaw_rate_radps_ = 0.0;
  std::int64_t stamp_us_ = 1'000'000'000;
};

}  // namespace cremed::simulation
