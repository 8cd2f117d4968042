// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/driven_path.hpp"

#include <cmath>

namespace cremed {
namespace {

PathPose moved_on(const PathPose& from, std::int64_t utime_us, const Pose2& truth,
                  const Eigen::Vector3d& motion) {
  PathPose pose = from;
  pose.utime_us = utime_us;
  pose.truth = truth;
  pose.estimate = moved(from.estimate, motion);
  pose.driven_m += std::hypot(truth.x_m - from.truth.x_m, truth.y_m - from.truth.y_m);
  return pose;
}

}  // namespace

std::vector<PathPose> driven_path(const std::vector<RecordedEstimate>& estimates,
                                  const TrueTrajectory& truth) {
  std::vector<PathPose> path;
  for (const RecordedEstimate& estimate : estimates) {
    const auto start = truth.at(estimate.start_us);
    const auto end = truth.at(estimate.end_us);
    if (!start || !end) {
      continue;
    }
    if (path.empty()) {
      path.push_back({estimate.start_us, *start, *start, 0.0, 0});
    } else if (path.back().utime_us != estimate.start_us) {
      const Eigen::Vector3d unseen = motion_between(path.back().truth, *start);
      path.push_back(moved_on(path.back(), estimate.start_us, *start, unseen));
      ++path.back().gaps;
    }
    path.push_back(moved_on(path.back(), estimate.end_us, *end, estimate.motion));
  }
  return path;
}

}  // namespace cremed
