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

#include "tools/eval/chi_square.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/against_wheels.hpp"
#include "tools/eval/drive/path_drift.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/trajectory_segments.hpp"
#include "tools/eval/drive/true_trajectory.hpp"
#include "tools/eval/drive/truth_noise.hpp"
#include "tools/eval/drive/wheel_reference.hpp"

namespace cremed {

/// The reference of a drive.
struct DriveReference {
  TrueTrajectory truth;
  TruthNoise truth_noise;                ///< Added to covariances compared with truth.
  std::optional<WheelReference> wheels;  ///< If available.
};

/// Time interval of a motion.
struct MeanRates {
  double forward_mps = 0.0;
  double yaw_radps = 0.0;
};

/// An estimate against truth. Order of states: (x_m, y_m, yaw_rad).
struct EstimateError {
  std::int64_t utime_us = 0;
  Eigen::Vector3d error;
  Eigen::Vector3d sigma;  ///< Including the noise of truth.
  double nees = 0.0;      ///< Per degree of freedom.
  MeanRates estimate;
  MeanRates truth;
};

inline constexpr std::int64_t kNeesWindowUs = 2'000'000;

/// Mean of NEES over a window, and the 95 % interval of such means for credible, independent
/// estimates. (Neighbours share a scan, so slightly more lie outside.)
struct RunningNees {
  double mean = 0.0;
  Interval interval;
};

/// For each estimate, in order of time, the mean of those at most half a window away.
std::vector<RunningNees> running_nees(const std::vector<EstimateError>& estimates,
                                      int degrees_of_freedom);

/// One source's odometry against truth.
struct SourceEvaluation {
  std::string source;
  int degrees_of_freedom = 2;
  Credibility credibility{2};
  TimeSpan time;  ///< Of the estimates; zero without any.
  Availability availability;
  std::size_t without_estimate = 0;    ///< Rows whose status has no estimate.
  std::size_t outside_truth = 0;       ///< Estimates outside of truth's time.
  std::vector<EstimateError> errors;   ///< Of all other estimates.
  std::vector<RunningNees> mean_nees;  ///< For each error, over kNeesWindowUs.
  std::vector<PathPose> path;
  std::vector<PathDrift> drift;
  std::int64_t first_window_us = 0;  ///< Of segments by time.
  std::vector<SegmentErrors> segments;
  std::optional<MotionsAgainstWheels> wheels;  ///< With wheels only, as is twist.
  std::optional<TwistAgainstWheels> twist;     ///< Of the vehicle's state only.
};

/// Compares every estimate of a source with the reference. A source whose cov_yy is always 0 has 2
/// DoF. Several sources have the same windows, counted from the first.
SourceEvaluation evaluate_source(const RecordedOdometry& odometry, const DriveReference& reference,
                                 std::int64_t first_window_us);

/// Compares the estimates in a file of cremed with the reference. Odometry CSV: "fused" first, then
/// the other sources in order of appearance. The vehicle's state (--output-odometry), recognised by
/// its header: one source "odometry" with the motions since the anchors. Throws std::runtime_error.
std::vector<SourceEvaluation> evaluate_drive(std::istream& odometry,
                                             const DriveReference& reference);

}  // namespace cremed
