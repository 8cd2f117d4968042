// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/path_drift.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/credibility.hpp"

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

/// Sums during accumulation, means afterwards.
void divide_by_segments(PathDrift& drift) {
  const double count = divisor(drift.segments);
  drift.translation_percent /= count;
  drift.rotation_deg_per_m /= count;
}

void add_segment(PathDrift& drift, const PathPose& first, const PathPose& last) {
  if (first.gaps != last.gaps) {
    ++drift.across_gaps;
    return;
  }
  const Eigen::Vector3d truth = motion_between(first.truth, last.truth);
  const Eigen::Vector3d error = motion_between(first.estimate, last.estimate) - truth;
  const double yaw_rad = std::remainder(error.z(), 2.0 * std::numbers::pi);
  const double driven_m = last.driven_m - first.driven_m;
  ++drift.segments;
  drift.translation_percent += 100.0 * error.head<2>().norm() / driven_m;
  drift.rotation_deg_per_m += kDegPerRad * std::abs(yaw_rad) / driven_m;
}

PathDrift drift_over(double length_m, const std::vector<PathPose>& path) {
  PathDrift drift{.length_m = length_m};
  auto last = path.begin();
  for (const PathPose& first : path) {
    last = std::find_if(last, path.end(), [&](const PathPose& pose) {
      return pose.driven_m > first.driven_m + length_m;
    });
    if (last == path.end()) {
      break;
    }
    add_segment(drift, first, *last);
  }
  divide_by_segments(drift);
  return drift;
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

std::vector<PathDrift> path_drift(const std::vector<PathPose>& path) {
  std::vector<PathDrift> drifts;
  drifts.reserve(kDriftLengthsM.size());
  for (const double length_m : kDriftLengthsM) {
    drifts.push_back(drift_over(length_m, path));
  }
  return drifts;
}

PathDrift mean_drift(const std::vector<PathDrift>& drifts) {
  PathDrift mean;
  for (const PathDrift& drift : drifts) {
    mean.across_gaps += drift.across_gaps;
    if (drift.segments != 0) {
      const auto count = static_cast<double>(drift.segments);
      mean.segments += drift.segments;
      mean.translation_percent += count * drift.translation_percent;
      mean.rotation_deg_per_m += count * drift.rotation_deg_per_m;
    }
  }
  divide_by_segments(mean);
  return mean;
}

}  // namespace cremed
