// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "test/tools/drawn_sweep.hpp"
#include "tools/eval/drive/kellner_velocity.hpp"

using namespace cremed;
using namespace cremed::test;

TEST_CASE(
    "Velocity and yaw rate are found, with their sigma, though a third of the targets moves") {
  const Eigen::Vector3d twist =
      GENERATE(Eigen::Vector3d(12.0, 0.0, 0.0), Eigen::Vector3d(8.0, 0.1, 0.4),
               Eigen::Vector3d(-2.0, 0.0, -0.2), Eigen::Vector3d(0.0, 0.0, 0.0));
  double nees = 0.0;
  constexpr int kRuns = 40;
  for (unsigned seed = 0; seed < kRuns; ++seed) {
    DrawnWorld world(seed, 400);
    const Sweep sweep = world.sweep({}, twist, 0.1, 3);
    const auto velocity = kellner_velocity(sweep.targets);
    REQUIRE(velocity);
    const Eigen::Vector3d error = velocity->twist - twist;
    CHECK(std::abs(error.x()) < 0.15);
    CHECK(std::abs(error.z()) < 0.06);
    CHECK(velocity->standing.size() > sweep.targets.size() / 2);
    nees += error.dot(velocity->covariance.ldlt().solve(error)) / 3.0 / kRuns;
  }
  CHECK(nees > 0.5);
  CHECK(nees < 2.0);
}

TEST_CASE("Too few targets, or none that agree, tell no velocity") {
  CHECK_FALSE(kellner_velocity({}));
  DrawnWorld world(1, 400);
  Sweep sweep = world.sweep({}, {10.0, 0.0, 0.0}, 0.1, 1000);
  CHECK(kellner_velocity(sweep.targets));
  sweep.targets.resize(9);
  CHECK_FALSE(kellner_velocity(sweep.targets));
}

TEST_CASE("The same targets give the same velocity") {
  DrawnWorld world(2, 400);
  const Sweep sweep = world.sweep({}, {10.0, 0.0, 0.1}, 0.1, 3);
  CHECK(kellner_velocity(sweep.targets)->twist == kellner_velocity(sweep.targets)->twist);
}
