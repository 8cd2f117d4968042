// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/registration/learned_curvature.hpp"

namespace cremed {
namespace {

const Eigen::Vector3d kMinimum(0.3, -0.2, 0.05);

/// Complete information, of which the shares 0.3, 0.6 and 0.7 along its own axes are missing.
struct CurvatureProblem {
  CurvatureProblem() {
    complete << 40.0, 5.0, 10.0, 5.0, 30.0, -8.0, 10.0, -8.0, 90.0;
    const Eigen::Matrix3d root = complete.llt().matrixL();
    Eigen::Matrix3d turn;
    turn << 0.6, -0.8, 0.0, 0.8, 0.6, 0.0, 0.0, 0.0, 1.0;
    const Eigen::Matrix3d missing =
        turn * Eigen::Vector3d(0.3, 0.6, 0.7).asDiagonal() * turn.transpose();
    observed = complete - root * missing * root.transpose();
  }
  [[nodiscard]] Eigen::Vector3d gradient(const Eigen::Vector3d& at) const {
    return observed * (at - kMinimum);
  }

  Eigen::Matrix3d complete;
  Eigen::Matrix3d observed;
};

/// Distance from the minimum after some steps.
double distance_after(const CurvatureProblem& problem, int steps, bool is_learning) {
  LearnedCurvature curvature(3);
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector3d gradient = problem.gradient(at);
    const Eigen::Vector3d step = -curvature.of(problem.complete).llt().solve(gradient);
    at += step;
    if (is_learning) {
      curvature.add(step, problem.gradient(at) - gradient, problem.complete);
    }
  }
  return (at - kMinimum).norm();
}

const Eigen::Matrix3d kComplete = Eigen::Matrix3d::Identity();

TEST_CASE("three steps tell the curvature of three states: the fourth ends at the minimum") {
  const CurvatureProblem problem;
  CHECK(distance_after(problem, 4, true) < 1e-9);
  CHECK(distance_after(problem, 4, false) > 0.01);
}

TEST_CASE("steps are at most five times as long as those by the complete information") {
  LearnedCurvature curvature(3);
  const Eigen::Vector3d step(1.0, 0.0, 0.0);
  curvature.add(step, 0.25 * step, kComplete);
  CHECK(curvature.of(kComplete)(0, 0) == Approx(0.25));
  curvature.add(step, 0.15 * step, kComplete);
  CHECK(curvature.of(kComplete) == kComplete);
}

TEST_CASE("a gradient that changes more than expected teaches nothing") {
  LearnedCurvature curvature(3);
  const Eigen::Vector3d step(0.0, 0.5, 0.1);
  curvature.add(step, 1.5 * step, kComplete);
  CHECK(curvature.of(kComplete) == kComplete);
}

TEST_CASE("stopped, it forgets and learns no more") {
  LearnedCurvature curvature(3);
  const Eigen::Vector3d step(1.0, 0.0, 0.0);
  curvature.add(step, 0.5 * step, kComplete);
  REQUIRE(curvature.of(kComplete)(0, 0) == Approx(0.5));
  curvature.stop();
  CHECK(curvature.of(kComplete) == kComplete);
  curvature.add(step, 0.5 * step, kComplete);
  CHECK(curvature.of(kComplete) == kComplete);
}

TEST_CASE("in two degrees of freedom the gradient by y is not learned") {
  LearnedCurvature curvature(2);
  curvature.add({1.0, 0.0, 0.0}, {0.5, 7.0, 0.0}, kComplete);
  Eigen::Matrix3d expected = kComplete;
  expected(0, 0) = 0.5;
  CHECK(curvature.of(kComplete).isApprox(expected));
}

}  // namespace
}  // namespace cremed
