// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "test/tools/circle.hpp"
#include "tools/eval/drive/motion_chain.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

Eigen::Matrix3d some_covariance(double scale) {
  Eigen::Matrix3d root;
  root << 0.1, 0.0, 0.0, 0.03, 0.2, 0.0, -0.01, 0.02, 0.05;
  return scale * scale * root * root.transpose();
}

/// Exact states relative to anchors that are renewed every `rows` rows.
std::vector<RecordedEstimate> exact_since_anchors(const Circle& circle, std::size_t count,
                                                  std::size_t rows) {
  std::vector<RecordedEstimate> result;
  for (std::size_t i = 0; i < count; ++i) {
    const auto anchor_us = static_cast<std::int64_t>(i / rows * rows) * 100'000;
    const auto utime_us = static_cast<std::int64_t>(i + 1) * 100'000;
    const double time_s = static_cast<double>(utime_us - anchor_us) * 1e-6;
    result.push_back({anchor_us, utime_us, circle.motion(time_s), some_covariance(time_s)});
  }
  return result;
}

}  // namespace

TEST_CASE("The covariance of two motions is that of their derivatives") {
  const auto start_yaw_rad = GENERATE(0.0, 1e-8, 0.7, -3.0);
  const UncertainPose start{{3.0, -2.0, start_yaw_rad}, some_covariance(1.0)};
  const UncertainPose motion{{5.0, 0.4, 0.2}, some_covariance(0.5)};
  const UncertainPose both = chained(start, motion);
  Eigen::Matrix3d by_start;
  Eigen::Matrix3d by_motion;
  const double step = 1e-6;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(i);
    by_start.col(i) =
        (chained({start.pose + d, {}}, motion).pose - chained({start.pose - d, {}}, motion).pose) /
        (2.0 * step);
    by_motion.col(i) =
        (chained(start, {motion.pose + d, {}}).pose - chained(start, {motion.pose - d, {}}).pose) /
        (2.0 * step);
  }
  const Eigen::Matrix3d expected = by_start * start.covariance * by_start.transpose() +
                                   by_motion * motion.covariance * by_motion.transpose();
  CHECK(both.covariance.isApprox(expected, 1e-8));
  CHECK(both.covariance.isApprox(both.covariance.transpose()));
}

TEST_CASE("Motions that join make the way, motions since anchors make the same way") {
  const Circle circle;
  const auto rows = GENERATE(std::size_t{1}, std::size_t{7}, std::size_t{1000});
  CAPTURE(rows);
  MotionChain chain(0);
  for (const RecordedEstimate& estimate : exact_since_anchors(circle, 100, rows)) {
    REQUIRE(chain.add(estimate));
  }
  CHECK(chain.end_us() == 10'000'000);
  CHECK(chain.end().pose.isApprox(circle.motion(10.0), 1e-9));
  CHECK(chain.driven_m() == Approx(80.0).epsilon(1e-4));
}

TEST_CASE("Only the ends of the anchors' intervals are chained, with their covariances") {
  const Circle circle;
  const auto states = exact_since_anchors(circle, 25, 10);
  MotionChain chain(0);
  for (const RecordedEstimate& state : states) REQUIRE(chain.add(state));
  const auto piece = [&](std::size_t i) {
    return UncertainPose{states[i].motion, states[i].covariance};
  };
  const UncertainPose expected = chained(chained(piece(9), piece(19)), piece(24));
  CHECK(chain.end().covariance.isApprox(expected.covariance, 1e-9));
}

TEST_CASE("A motion that does not join is a gap") {
  const Circle circle;
  const auto estimates = exact_since_anchors(circle, 30, 10);
  MotionChain chain(0);
  REQUIRE(chain.add(estimates[0]));
  CHECK_FALSE(chain.add({1'000'000, 1'100'000, {}, {}}));
  CHECK(chain.end_us() == 100'000);
  // Without the state at the new anchor's time the chain is broken.
  MotionChain broken(0);
  for (std::size_t i = 0; i < 9; ++i) REQUIRE(broken.add(estimates[i]));
  CHECK_FALSE(broken.add(estimates[10]));
}
