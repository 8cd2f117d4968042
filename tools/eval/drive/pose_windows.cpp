// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/pose_windows.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "tools/eval/credibility.hpp"
#include "tools/eval/drive/motion_chain.hpp"
#include "tools/eval/drive/time_bracket.hpp"

namespace cremed {
namespace {

/// The true path is the sum of straight distances over this time: short against a turn, long
/// against the noise of truth.
constexpr std::int64_t kPathStepUs = 100'000;

/// Across a gap the path is the chord, unless it takes longer.
constexpr std::int64_t kLongestChordUs = 1'000'000;

/// Standing still has no path to refer to.
constexpr double kLeastPathM = 1.0;

/// Nothing across a long gap, in which the path is not known.
std::optional<double> true_path_m(const TrueTrajectory& truth, std::int64_t start_us,
                                  std::int64_t end_us) {
  double path_m = 0.0;
  std::int64_t from_us = start_us;
  for (std::int64_t to_us = start_us + kPathStepUs; to_us <= end_us; to_us += kPathStepUs) {
    if (to_us - from_us > kLongestChordUs) {
      return std::nullopt;
    }
    if (const auto motion = truth.motion(from_us, to_us)) {
      path_m += motion->head<2>().norm();
      from_us = to_us;
    }
  }
  return std::max(path_m, kLeastPathM);
}

}  // namespace

TrueTrajectory chained_poses(const std::vector<RecordedEstimate>& steps) {
  std::vector<std::int64_t> utime_us;
  std::vector<Pose2> poses;
  std::vector<TimeSpan> gaps;
  bool is_broken = false;  // Between the last pose and the next.
  const auto add = [&](std::int64_t time_us, const Pose2& pose) {
    if (!utime_us.empty() && time_us <= utime_us.back()) {
      return;
    }
    if (std::exchange(is_broken, false)) {
      gaps.push_back({utime_us.back(), time_us});
    }
    utime_us.push_back(time_us);
    poses.push_back(pose);
  };
  Pose2 pose;
  for (const RecordedEstimate& step : steps) {
    if (!utime_us.empty() && step.end_us <= utime_us.back()) {
      continue;
    }
    if (utime_us.empty() || !is_same_stamp(step.start_us, utime_us.back())) {
      is_broken = !utime_us.empty();
      add(step.start_us, pose);
    }
    pose = moved(pose, step.motion);
    add(step.end_us, pose);
  }
  return {std::move(utime_us), std::move(poses), std::move(gaps)};
}

std::int64_t first_window_us(const std::vector<RecordedOdometry>& sources,
                             const TrueTrajectory& truth) {
  std::optional<std::int64_t> begin_us;
  for (const RecordedOdometry& source : sources) {
    if (!source.steps().empty()) {
      const std::int64_t start_us = source.steps().front().start_us;
      begin_us = std::min(begin_us.value_or(start_us), start_us);
    }
  }
  const std::int64_t truth_us = truth.utime_us().empty() ? 0 : truth.utime_us().front();
  return std::max(begin_us.value_or(truth_us), truth_us) + kWindowStepUs;
}

WindowErrors window_errors(const TrueTrajectory& poses, const TrueTrajectory& truth,
                           std::int64_t first_us, std::int64_t length_us) {
  WindowErrors errors;
  const auto last_of = [&](const TrueTrajectory& of) {
    return of.utime_us().empty() ? first_us : of.utime_us().back();
  };
  const std::int64_t last_us = std::min(last_of(truth), last_of(poses));
  for (std::int64_t begin_us = first_us; begin_us + length_us <= last_us;
       begin_us += kWindowStepUs) {
    const std::int64_t end_us = begin_us + length_us;
    const auto motion = poses.unbroken_motion(begin_us, end_us);
    const auto true_motion = truth.motion(begin_us, end_us);
    const auto path_m = true_path_m(truth, begin_us, end_us);
    if (motion && true_motion && path_m) {
      const Eigen::Vector3d error = estimation_error(*motion, *true_motion);
      ++errors.windows;
      errors.rmse += error.cwiseAbs2();
      errors.position_percent += 100.0 * error.head<2>().norm() / *path_m;
    }
  }
  const double count = divisor(errors.windows);
  errors.rmse = (errors.rmse / count).cwiseSqrt();
  errors.position_percent /= count;
  return errors;
}

}  // namespace cremed
