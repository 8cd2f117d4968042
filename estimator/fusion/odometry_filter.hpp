// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimator/fusion/gaussian_state.hpp"
#include "estimator/fusion/odometry.hpp"
#include "estimator/fusion/odometry_options.hpp"
#include "estimator/fusion/radar_measurement.hpp"
#include "estimator/fusion/radar_track.hpp"
#include "estimator/fusion/vehicle_motion.hpp"
#include "estimator/pose2.hpp"
#include "estimator/registration_options.hpp"
#include "estimator/target_set.hpp"

namespace cremed {

/// A radar as the filter knows it.
struct OdometryRadar {
  Pose2 vehicle_from_radar;
  RegistrationOptions registration;
};

/// One state of the vehicle from the scans of all its radars.
class OdometryFilter {
 public:
  OdometryFilter(const OdometryOptions& options, std::span<const OdometryRadar> radars);

  Odometry update(std::size_t radar, const TargetSet& targets, std::int64_t stamp_us);

  [[nodiscard]] const GaussianState& state() const { return state_; }
  struct Debug { double doppler_nis; int pairs; double nis[3]; int lag[3]; double v[2]; double dres[2]; double std; int used; } debug;

 private:
  struct Pair {
    std::size_t keyframe;
    Eigen::Vector3d motion;
    Eigen::Matrix3d covariance;
  };
  void start(std::int64_t stamp_us);
  void advance(std::int64_t stamp_us);
  void forget_errors(std::size_t radar, std::int64_t stamp_us);
  void use_doppler(std::size_t radar, const TargetSet& targets, double age_s);
  void use_positions(std::size_t radar, const TargetSet& targets, double age_s);
  void renew_anchor();
  void finish(Odometry& odometry);
  [[nodiscard]] RadarModel model(std::size_t radar) const;

  OdometryOptions options_;
  GaussianState state_;
  std::vector<std::unique_ptr<RadarTrack>> tracks_;
  std::array<Pair, state_layout::kKeyframes> pairs_{};
  std::size_t pair_count_ = 0;
  bool has_started_ = false;
  std::int64_t time_us_ = 0;
  std::int64_t anchor_us_ = 0;
  std::int64_t output_us_ = 0;
  std::uint32_t radars_ = 0;
  Eigen::Vector3d odom_pose_ = Eigen::Vector3d::Zero();
};

}  // namespace cremed
