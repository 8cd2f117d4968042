// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/radar_sweep.hpp"

namespace cremed {

/// The vehicle's (vx, vy, yaw rate) from the Doppler of all its radars at one time.
struct KellnerVelocity {
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::vector<std::size_t> standing;  ///< Indices of the inliers.
};

/// Kellner et al., "Instantaneous ego-motion estimation using Doppler radar" (ITSC 2013) and "...
/// using multiple Doppler radars" (ICRA 2014): RANSAC with samples of three targets; the motion
/// with the most inliers is refined by least squares. Deterministic. Nothing if there are fewer
/// than ten inliers.
std::optional<KellnerVelocity> kellner_velocity(const std::vector<SweepTarget>& targets);

}  // namespace cremed
