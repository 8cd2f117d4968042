// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/against_wheels.hpp"
#include "tools/eval/drive/driven_path.hpp"
#include "tools/eval/drive/path_drift.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/running_nees.hpp"
#include "tools/eval/drive/trajectory_segments.hpp"
#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/eval/drive/truth_noise.hpp"
#include "tools/eval/drive/twist_against_wheels.hpp"
#include "tools/eval/drive/wheel_reference.hpp"

namespace cremed {

/// What a drive is compared with.
struct DriveReference {
  TrueTrajectory truth;
  TruthNoise truth_noise;                ///< Added to covariances that are compared with truth.
  std::optional<WheelReference> wheels;  ///< If there are any.
};

/// Of a motion, over its time.
struct MeanRates {
  double forward_mps = 0.0;
  double yaw_radps = 0.0;
};

/// An estimate against truth. Order of states: (x_m, y_m, yaw_rad).
struct EstimateError {
  std::int64_t utime_us = 0;
  Eigen::Vector3d error;
  Eigen::Vector3d sigma;  ///< With the noise of truth.
  double nees = 0.0;      ///< Per degree of freedom.
  MeanRates estimate;
  MeanRates truth;
};

/// One source's odometry against truth.
struct SourceEvaluation {
  std::string source;
  int degrees_of_freedom = 2;
  Credibility credibility{2};
  std::size_t without_estimate = 0;    ///< Rows whose status says that there is no estimate.
  std::size_t outside_truth = 0;       ///< Estimates that truth does not cover in time.
  std::vector<EstimateError> errors;   ///< Of the others.
  std::vector<RunningNees> mean_nees;  ///< For each error, over kNeesWindowUs.
  std::vector<PathPose> path;
  std::vector<PathDrift> drift;
  std::vector<SegmentErrors> segments;
  std::optional<MotionsAgainstWheels> wheels;  ///< If there are wheels, like the next.
  std::optional<TwistAgainstWheels> twist;     ///< Of the vehicle's state only.
};

inline constexpr std::int64_t kNeesWindowUs = 2'000'000;

/// Compares every estimate of a source with the reference. One whose cov_yy is 0 throughout is
/// taken as 2 DoF.
SourceEvaluation evaluate_source(const RecordedOdometry& odometry, const DriveReference& reference);

/// Reads what cremed wrote and compares every estimate with the reference: odometry CSV, "fused"
/// first, then the others in order of appearance, or, told by its header, the vehicle's state
/// (--output-odometry), one source "odometry" whose motions are those since their anchors. Throws
/// std::runtime_error.
std::vector<SourceEvaluation> evaluate_drive(std::istream& odometry,
                                             const DriveReference& reference);

}  // namespace cremed
