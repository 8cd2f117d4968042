// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/trajectory_error.hpp"

#include <cmath>
#include <complex>

#include "tools/eval/credibility.hpp"

namespace cremed {
namespace {

using Position = std::complex<double>;

Position position(const Pose2& pose) { return {pose.x_m, pose.y_m}; }

}  // namespace

TrajectoryError trajectory_error(const std::vector<PathPose>& path) {
  const double count = divisor(path.size());
  Position mean;
  Position true_mean;
  for (const PathPose& pose : path) {
    mean += position(pose.estimate) / count;
    true_mean += position(pose.truth) / count;
  }
  // The turn that aligns best is the angle of this sum (Umeyama 1991, in the plane).
  Position turn;
  for (const PathPose& pose : path) {
    turn += std::conj(position(pose.estimate) - mean) * (position(pose.truth) - true_mean);
  }
  turn = std::polar(1.0, std::arg(turn));
  TrajectoryError squares;
  for (const PathPose& pose : path) {
    const Position estimate = position(pose.estimate);
    const Position truth = position(pose.truth);
    squares.from_begin_m += std::norm(estimate - truth);
    squares.aligned_m += std::norm(turn * (estimate - mean) - (truth - true_mean));
  }
  return {std::sqrt(squares.from_begin_m / count), std::sqrt(squares.aligned_m / count)};
}

}  // namespace cremed
