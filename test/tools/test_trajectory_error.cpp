// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "tools/eval/drive/trajectory_error.hpp"

using namespace cremed;

namespace {

/// The same path in two frames: that of the estimate is this pose in that of truth.
std::vector<PathPose> seen_from(const Eigen::Vector3d& frame) {
  std::vector<PathPose> path;
  for (int i = 0; i <= 50; ++i) {
    const Eigen::Vector3d pose{1.0 * i, 0.02 * i * i, 0.04 * i};
    path.push_back({.truth = moved(moved({}, frame), pose), .estimate = moved({}, pose)});
  }
  return path;
}

}  // namespace

TEST_CASE("A path that is only moved and turned has no error once it is aligned") {
  for (const double yaw_rad : {-3.0, 0.0, 0.1, 3.0}) {
    const TrajectoryError error = trajectory_error(seen_from({5.0, -12.0, yaw_rad}));
    CHECK(error.aligned_m == Approx(0.0).margin(1e-9));
    CHECK(error.from_begin_m > 10.0);
  }
}

TEST_CASE("Where the path is too long by 1 % on a straight road, aligning halves the error") {
  std::vector<PathPose> path;
  for (int i = 0; i <= 1000; ++i) {
    path.push_back({.truth = {0.1 * i, 3.0, 0.0}, .estimate = {0.101 * i, 3.0, 0.0}});
  }
  const TrajectoryError error = trajectory_error(path);
  CHECK(error.from_begin_m == Approx(1.0 / std::sqrt(3.0)).epsilon(1e-3));
  CHECK(error.aligned_m == Approx(1.0 / std::sqrt(12.0)).epsilon(1e-3));
}

TEST_CASE("No path has no error") { CHECK(std::isnan(trajectory_error({}).aligned_m)); }
