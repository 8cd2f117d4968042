// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "daemon/configuration/configuration.hpp"
#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// A target of one of several radars, in the vehicle frame.
struct SweepTarget {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  /// Its Doppler per vehicle (vx, vy, yaw rate), if it is static.
  Eigen::RowVector3d doppler_by_twist = Eigen::RowVector3d::Zero();
  double doppler_mps = 0.0;
  double age_s = 0.0;  ///< Age of its scan relative to the sweep; may be negative.
};

/// The targets of all radars at about one time: for each scan of the first radar, the nearest scan
/// in time of every other radar within 50 ms.
struct Sweep {
  std::int64_t stamp_us = 0;
  std::vector<SweepTarget> targets;
};

std::vector<Sweep> sweeps(const Configuration& configuration,
                          const std::vector<RecordedRadar>& radars);

}  // namespace cremed
