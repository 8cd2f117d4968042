// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/pose_windows.hpp"

#include <algorithm>
#include <cmath>

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

ChainedPoses::ChainedPoses(const std::vector<RecordedEstimate>& steps) {
  for (const RecordedEstimate& step : steps) {
    Place place = places_.empty() ? Place{} : places_.back();
    if (utime_us_.empty() || !is_same_stamp(step.start_us, utime_us_.back())) {
      place.gaps += utime_us_.empty() ? 0 : 1;
      push(step.start_us, place);
    }
    place.pose = moved(place.pose, step.motion);
    push(step.end_us, place);
  }
}

void ChainedPoses::push(std::int64_t utime_us, const Place& place) {
  if (utime_us_.empty() || utime_us > utime_us_.back()) {
    utime_us_.push_back(utime_us);
    places_.push_back(place);
  }
}

std::optional<ChainedPoses::Place> ChainedPoses::at(std::int64_t utime_us) const {
  const auto place = bracket(utime_us_, utime_us);
  if (!place || places_[place->left].gaps != places_[place->right].gaps) {
    return std::nullopt;
  }
  const Pose2& a = places_[place->left].pose;
  const Pose2& b = places_[place->right].pose;
  return Place{{std::lerp(a.x_m, b.x_m, place->share), std::lerp(a.y_m, b.y_m, place->share),
                std::lerp(a.yaw_rad, b.yaw_rad, place->share)},
               places_[place->left].gaps};
}

std::optional<Eigen::Vector3d> ChainedPoses::motion(std::int64_t start_us,
                                                    std::int64_t end_us) const {
  const auto start = at(start_us);
  const auto end = at(end_us);
  if (!start || !end || start->gaps != end->gaps) {
    return std::nullopt;
  }
  return motion_between(start->pose, end->pose);
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

WindowErrors window_errors(const ChainedPoses& poses, const TrueTrajectory& truth,
                           std::int64_t first_us, std::int64_t length_us) {
  WindowErrors errors;
  const std::int64_t of_truth_us = truth.utime_us().empty() ? first_us : truth.utime_us().back();
  const std::int64_t last_us = std::min(of_truth_us, poses.last_us().value_or(first_us));
  for (std::int64_t begin_us = first_us; begin_us + length_us <= last_us;
       begin_us += kWindowStepUs) {
    const std::int64_t end_us = begin_us + length_us;
    const auto motion = poses.motion(begin_us, end_us);
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
