// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "estimator/fusion/doppler_velocity.hpp"
#include "estimator/fusion/odometry_options.hpp"
#include "estimator/fusion/state_layout.hpp"
#include "estimator/pose2.hpp"
#include "estimator/registration.hpp"
#include "estimator/target_set.hpp"

namespace cremed {

/// What the odometry filter keeps of one radar besides its states.
struct RadarTrack {
  struct Keyframe {
    bool is_set = false;
    int lag = 0;  ///< Scans since.
    TargetSet targets;
  };

  RadarTrack(const RegistrationOptions& options, const Pose2& mount)
      : vehicle_from_radar(mount), registration(options, mount) {}

  Pose2 vehicle_from_radar;
  Registration registration;
  DopplerVelocityEstimator doppler;
  std::array<Keyframe, state_layout::kKeyframes> keyframes;
  bool has_stamp = false;
  std::int64_t stamp_us = 0;
  double doppler_std_mps = 0.0;
  Eigen::Matrix3d scan_covariance = Eigen::Matrix3d::Zero();
};

}  // namespace cremed
