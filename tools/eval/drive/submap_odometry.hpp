// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/drive/kellner_velocity.hpp"
#include "tools/eval/drive/ndt_map.hpp"
#include "tools/eval/drive/radar_sweep.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// Matches each sweep with a map of the last ten, after Kung et al., "A normal distribution
/// transform-based radar odometry designed for scanning and automotive radars" (ICRA 2021): targets
/// that stand by their Doppler only (Kellner), where the vehicle was at their scan's time by its
/// velocity; matching starts where that velocity leads, and takes it as a measurement.
class SubmapOdometry {
 public:
  struct Result {
    Eigen::Vector3d motion = Eigen::Vector3d::Zero();  ///< Since the sweep before, in its frame.
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  /// `motion`: by velocity, since the sweep before, `dt_s` ago.
  Result update(const Sweep& sweep, const KellnerVelocity& velocity, const Eigen::Vector3d& motion,
                double dt_s);

 private:
  [[nodiscard]] NdtMap submap() const;

  Pose2 pose_;
  std::deque<std::vector<UncertainPoint>> sweeps_;  // In the frame of the first pose.
};

}  // namespace cremed
