// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "test/tools/circle.hpp"
#include "tools/eval/drive/pose_windows.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// Without errors.
std::vector<RecordedEstimate> exact_steps(const Circle& circle, std::int64_t step_us,
                                          std::size_t steps) {
  Random unused(0, 0);
  return circle.estimates(step_us, steps, Eigen::Matrix3d::Zero(), unused);
}

}  // namespace

TEST_CASE("Poses between the steps' ends are interpolated") {
  const Circle circle{10.0, 0.1};
  const TrueTrajectory poses = chained_poses(exact_steps(circle, 75'000, 100));
  const auto motion = poses.motion(512'345, 6'012'345);
  REQUIRE(motion);
  CHECK(motion->isApprox(circle.motion(5.5), 1e-4));
  CHECK(poses.motion(0, 7'500'000));
  CHECK_FALSE(poses.motion(0, 7'500'001));
  CHECK_FALSE(poses.motion(-1, 1'000'000));
}

TEST_CASE("A step that ends no later than the last is left out, and is no gap") {
  const Circle circle{10.0, 0.1};
  const auto steps = exact_steps(circle, 75'000, 100);
  auto repeated = steps;
  repeated.insert(repeated.begin() + 40, steps[39]);
  RecordedEstimate standing = steps[60];
  standing.end_us = standing.start_us;
  repeated.insert(repeated.begin() + 61, standing);
  const TrueTrajectory poses = chained_poses(repeated);
  CHECK(poses.gaps().empty());
  CHECK(*poses.motion(0, 7'500'000) == *chained_poses(steps).motion(0, 7'500'000));
}

TEST_CASE("Windows begin one step after both have begun, half a second apart, to the end of both") {
  const Circle circle;
  const auto truth = exact_truth(circle, 100);
  auto steps = exact_steps(circle, kStepUs, 90);
  for (RecordedEstimate& step : steps) {
    step.start_us += 230'000;
    step.end_us += 230'000;
  }
  const std::int64_t first_us = first_window_us({{"late", steps, 0}, {"blind", {}, 5}}, truth);
  CHECK(first_us == 730'000);
  const WindowErrors errors = window_errors(chained_poses(steps), truth, first_us, 2'000'000);
  CHECK(errors.windows == 14);  // From 0.73 to 7.23 s; the steps end at 9.23 s.
  CHECK(errors.rmse.z() == Approx(0.0).margin(1e-9));
  CHECK(first_window_us({}, truth) == 500'000);
  CHECK(std::isnan(window_errors(chained_poses({}), truth, 0, 2'000'000).rmse.z()));
  CHECK(window_errors(chained_poses(steps), {}, 0, 2'000'000).windows == 0);
}

TEST_CASE("A damaged last stamp of truth adds no windows, and takes no time") {
  const Circle circle;
  const auto steps = exact_steps(circle, kStepUs, 90);
  const auto truth = exact_truth(circle, 100);
  std::vector<std::int64_t> utime_us = truth.utime_us();
  std::vector<Pose2> poses;
  for (const std::int64_t utime : utime_us) {
    poses.push_back(*truth.at(utime));
  }
  utime_us.push_back(9'000'000'000'000'000);
  poses.push_back(poses.back());
  const TrueTrajectory damaged(utime_us, poses);
  const auto windows = [&](const TrueTrajectory& of) {
    return window_errors(chained_poses(steps), of, 500'000, 2'000'000).windows;
  };
  CHECK(windows(damaged) == windows(truth));
}

TEST_CASE("A constant error of scale and of yaw rate is that of every window") {
  const Circle circle{8.0, 1e-9};
  auto steps = exact_steps(circle, kStepUs, 200);
  for (RecordedEstimate& step : steps) {
    step.motion.x() *= 1.02;
  }
  const auto truth = exact_truth(circle, 200);
  const auto scale = window_errors(chained_poses(steps), truth, 500'000, 5'000'000);
  CHECK(scale.windows == 30);
  CHECK(scale.rmse.x() == Approx(0.8));
  CHECK(scale.position_percent == Approx(2.0));
  for (RecordedEstimate& step : steps) {
    step.motion.z() += 0.002;
  }
  const auto turned = window_errors(chained_poses(steps), truth, 500'000, 5'000'000);
  CHECK(turned.rmse.z() == Approx(0.1));
}

TEST_CASE("A window across a gap is left out; stamps that differ by their rounding are no gap") {
  const Circle circle;
  auto steps = exact_steps(circle, kStepUs, 100);
  steps[20].start_us += 2;
  const auto truth = exact_truth(circle, 100);
  const auto windows = [&] {
    return window_errors(chained_poses(steps), truth, 500'000, 3'000'000).windows;
  };
  CHECK(windows() == 14);
  steps.erase(steps.begin() + 52);
  CHECK(windows() == 4 + 4);  // Begun up to 2 s, or from 5.5 s on.
}

TEST_CASE("A window with an end in a gap of truth, or with a long gap in it, is left out") {
  const Circle circle;
  const auto steps = exact_steps(circle, kStepUs, 100);
  const auto errors = [&](std::size_t first, std::size_t last) {
    return window_errors(chained_poses(steps), with_gap(exact_truth(circle, 100), first, last),
                         500'000, 2'000'000);
  };
  CHECK(errors(53, 53).windows == 16);  // One pose less is interpolated.
  CHECK(errors(48, 52).windows == 14);  // Not those that begin or end at 5 s.
  CHECK(errors(48, 52).rmse.x() < 1e-6);
  CHECK(errors(48, 52).position_percent < 0.01);
  CHECK(errors(40, 70).windows == 3 + 2);  // Up to 3.9 s, or from 7.1 s on.
}

TEST_CASE("Standing still, an error counts as one over a metre") {
  const Circle circle{1e-9, 1e-9};
  auto steps = exact_steps(circle, kStepUs, 50);
  for (RecordedEstimate& step : steps) {
    step.motion.x() = 0.001;
  }
  const auto errors =
      window_errors(chained_poses(steps), exact_truth(circle, 50), 500'000, 1'000'000);
  CHECK(errors.position_percent == Approx(1.0));
}
