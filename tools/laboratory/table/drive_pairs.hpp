// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "daemon/configuration/configuration.hpp"
#include "tools/eval/drive/trajectory_segments.hpp"
#include "tools/eval/drive/truth_noise.hpp"

namespace cremed {

/// One drive to evaluate.
struct DriveToPair {
  std::string log;
  std::string truth;
  Configuration configuration;
  TruthNoise truth_noise{};  ///< Added to the covariances of all methods.
};

/// An estimate with the true motion, in the order (x_m, y_m, yaw_rad).
struct PairedMotion {
  Eigen::Vector3d motion;
  Eigen::Matrix3d covariance;
  Eigen::Vector3d truth;
};

/// Results of one method for the pairs of scans.
struct PairedMotions {
  std::vector<PairedMotion> motions;
  std::size_t left_out = 0;  ///< Pairs without an estimate.
};

/// One radar's motions from scan to scan, and the odometry of the whole drive.
struct DrivePairs {
  PairedMotions paper;          ///< The paper's estimator without Doppler.
  PairedMotions paper_doppler;  ///< The paper's estimator with Doppler.
  PairedMotions own;            ///< The daemon's estimates.
  std::vector<SegmentErrors> odometry;
};

/// The evaluated radar: the one named "front", otherwise the first.
std::size_t paired_radar(const Configuration& configuration);

/// The paper's estimator has the settings of `profile` (profile.hpp), uses the paper's selection of
/// ARS408 clusters (invalid states 0, 4 and 11, stationary) and no corrections. Throws
/// std::runtime_error.
DrivePairs pair_drive(const DriveToPair& drive, std::string_view profile);

}  // namespace cremed
