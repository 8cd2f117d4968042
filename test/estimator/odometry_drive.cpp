// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/odometry_drive.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "test/estimator/numeric.hpp"

namespace cremed::simulation {

OdometryDrive::OdometryDrive(const std::vector<Pose2>& mounts, std::uint64_t seed,
                             const OdometryOptions& options,
                             const std::vector<std::optional<LearnedErrors>>& learned)
    : random_(seed) {
  for (const Pose2& mount : mounts) {
    radars_.push_back({mount, mount});
  }
  filter_ = std::make_unique<OdometryFilter>(options, mounts, learned);
  points_ = scatter(random_, 2500, 3.0, 250.0, numeric::radians(180.0), 0.5);
}

Odometry OdometryDrive::next() {
  do {
    pass(kPeriodUs / static_cast<std::int64_t>(radars_.size()));
    turn_ = (turn_ + 1) % radars_.size();
  } while (radars_[turn_].is_silent);
  const Odometry odometry = filter_->update(turn_, see(turn_), stamp_us_);
  doppler_factor_ *= filter_->take_doppler_factor();
  return odometry;
}

Odometry OdometryDrive::drive(double time_s) {
  Odometry odometry;
  const std::int64_t end_us = stamp_us_ + static_cast<std::int64_t>(time_s * 1e6);
  while (stamp_us_ < end_us) {
    odometry = next();
  }
  return odometry;
}

void OdometryDrive::pass(std::int64_t time_us) {
  constexpr std::int64_t kStepUs = 1000;
  for (std::int64_t left_us = time_us; left_us > 0; left_us -= kStepUs) {
    const double dt_s = static_cast<double>(std::min(left_us, kStepUs)) * 1e-6;
    const double yaw_rad = yaw_rate_radps_ * dt_s;
    const Eigen::Vector2d way_m =
        Eigen::Rotation2Dd(0.5 * yaw_rad) * Eigen::Vector2d(speed_mps_ * dt_s, side_mps_ * dt_s);
    pose_ = composed_pose(pose_, {way_m.x(), way_m.y(), yaw_rad});
  }
  stamp_us_ += time_us;
}

TargetSet OdometryDrive::see(std::size_t which) {
  constexpr double kRangeM = 50.0;
  constexpr double kFarM = kRangeM + 10.0;  // From the vehicle: no radar sees that far.
  const Radar& radar = radars_[which];
  Detections detections;
  for (const Eigen::Vector2d& point : points_) {
    if ((point - pose_.head<2>()).squaredNorm() > kFarM * kFarM) {
      continue;
    }
    const double traffic_mps = (&point - points_.data()) % 4 != 0 ? radar.traffic_mps : 0.0;
    const Eigen::Vector3d velocity(speed_mps_ - radar.world_mps - traffic_mps, side_mps_,
                                   yaw_rate_radps_);
    const Detection detection =
        observe(seen_from(pose_, point), velocity, radar.mount, {0.1, 0.008, 0.1});
    if (std::abs(detection.azimuth_rad) < numeric::radians(60.0) && detection.range_m < kRangeM &&
        detections.size() < 100) {
      detections.push_back(detection);
    }
  }
  perturb(detections, random_);
  for (Detection& detection : detections) {
    detection.doppler_mps *= radar.doppler_scale * doppler_factor_;
  }
  return targets(detections, radar.configured);
}

}  // namespace cremed::simulation
