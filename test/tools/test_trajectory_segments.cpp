// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "test/tools/circle.hpp"
#include "tools/eval/chi_square.hpp"
#include "tools/eval/drive/motion_chain.hpp"
#include "tools/eval/drive/trajectory_segments.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr std::int64_t kStepUs = 100'000;

Eigen::Matrix3d covariance() {
  return Eigen::Vector3d(0.01, 0.005, 0.001).cwiseAbs2().asDiagonal();
}

TrueTrajectory exact_truth(const Circle& circle, std::size_t steps) {
  Random unused(0, 0);
  return circle.truth(kStepUs, steps, Eigen::Vector3d::Zero(), unused);
}

const SegmentErrors& of(const std::vector<SegmentErrors>& all, const std::string& length) {
  for (const SegmentErrors& errors : all) {
    if (to_text(errors.length) == length) return errors;
  }
  throw std::invalid_argument("no such length");
}

/// The number of segments without overlap determines the accuracy of a mean.
void check_is_one(double nees, double apart, int degrees_of_freedom) {
  const Interval interval =
      anees_interval(static_cast<std::size_t>(apart), degrees_of_freedom, 0.999);
  CHECK(nees > interval.low);
  CHECK(nees < interval.high);
}

/// The motions as states relative to anchors: each is the motion since the last anchor, with the
/// errors and covariances of all motions since.
std::vector<RecordedEstimate> since_anchors(const std::vector<RecordedEstimate>& motions,
                                            std::size_t rows) {
  std::vector<RecordedEstimate> states;
  UncertainPose pose;
  std::int64_t anchor_us = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    if (i % rows == 0) {
      pose = {};
      anchor_us = motions[i].start_us;
    }
    pose = chained(pose, {motions[i].motion, motions[i].covariance});
    states.push_back({anchor_us, motions[i].end_us, pose.pose, pose.covariance});
  }
  return states;
}

}  // namespace

TEST_CASE("Independent errors of true covariance give ANEES 1 at every length, anchored or not") {
  const auto rows_per_anchor = GENERATE(std::size_t{0}, std::size_t{20});
  CAPTURE(rows_per_anchor);
  const Circle circle{8.0, 0.05};
  constexpr std::size_t kSteps = 20'000;  // 2000 s, 16 km
  Random random(21, 0);
  auto estimates = circle.estimates(kStepUs, kSteps, covariance(), random);
  if (rows_per_anchor != 0) estimates = since_anchors(estimates, rows_per_anchor);
  const auto all = trajectory_segments(estimates, exact_truth(circle, kSteps), {});
  REQUIRE(all.size() == 7);
  const std::size_t begins = rows_per_anchor == 0 ? kSteps / 5 : kSteps / rows_per_anchor;
  for (const SegmentErrors& errors : all) {
    CAPTURE(to_text(errors.length), errors.segments);
    const double seconds = std::min(errors.length.time_s, errors.length.way_m / 8.0);
    CHECK(errors.segments > begins - 62);
    CHECK(errors.segments <= begins);
    const double apart = std::min(2000.0 / seconds, static_cast<double>(begins));
    check_is_one(errors.anees, apart, 3);
    check_is_one(errors.nees.x(), apart, 1);
    check_is_one(errors.nees.y(), apart, 1);
    check_is_one(errors.nees.z(), apart, 1);
    CHECK(errors.rmse.z() ==
          Approx(0.001 * std::sqrt(std::ceil(10.0 * seconds - 1e-9))).epsilon(0.25));
  }
}

TEST_CASE("An error that stays shows in the chain, though each motion's is within its sigma") {
  const Circle circle;
  Random random(22, 0);
  auto estimates = circle.estimates(kStepUs, 400, 1e-12 * Eigen::Matrix3d::Identity(), random);
  for (RecordedEstimate& estimate : estimates) {
    estimate.motion.z() += 0.001;
    estimate.covariance = covariance();
  }
  const auto all = trajectory_segments(estimates, exact_truth(circle, 400), {});
  // 100 motions: 0.1 rad at a sigma of 0.01.
  CHECK(of(all, "10 s").nees.z() == Approx(100.0).epsilon(1e-3));
  CHECK(of(all, "10 s").rmse.z() == Approx(0.1).epsilon(1e-3));
  CHECK(of(all, "1 s").nees.z() == Approx(10.0).epsilon(1e-3));
}

TEST_CASE("An error of scale is its share of the way; segments end at or beyond their length") {
  const Circle straight{8.0, 1e-9};
  Random random(23, 0);
  auto estimates = straight.estimates(kStepUs, 400, 1e-12 * Eigen::Matrix3d::Identity(), random);
  for (RecordedEstimate& estimate : estimates) {
    estimate.motion.x() *= 1.02;
    estimate.covariance = covariance();
  }
  const auto all = trajectory_segments(estimates, exact_truth(straight, 400), {});
  for (const SegmentErrors& errors : all) {
    CAPTURE(to_text(errors.length));
    CHECK(errors.position_percent == Approx(100.0 * 0.02 / 1.02).epsilon(1e-3));
  }
  // 13 motions of 0.816 m are 10.6 m; every fifth of 400 begins a segment unless the end is too
  // near.
  CHECK(of(all, "10 m").rmse.x() == Approx(13 * 0.016).epsilon(1e-3));
  CHECK(of(all, "10 m").segments == 78);
  CHECK(of(all, "30 s").segments == 21);
}

TEST_CASE("Truth's noise is added at the end, by the time that the segment takes") {
  const Circle circle;
  Random random(24, 0);
  auto estimates = circle.estimates(kStepUs, 400, 1e-12 * Eigen::Matrix3d::Identity(), random);
  for (RecordedEstimate& estimate : estimates) estimate.motion.z() += 0.001;
  const TruthNoise noise({{0.01, 0.01, 0.01, 1.0}, {0.01, 0.01, 0.1, 10.0}});
  const auto all = trajectory_segments(estimates, exact_truth(circle, 400), noise);
  CHECK(of(all, "1 s").nees.z() == Approx(1.0).epsilon(1e-3));
  CHECK(of(all, "10 s").nees.z() == Approx(1.0).epsilon(1e-3));
}

TEST_CASE("Segments across a gap and beyond truth are left out") {
  const Circle circle;
  Random random(25, 0);
  auto estimates = circle.estimates(kStepUs, 400, covariance(), random);
  const auto truth = exact_truth(circle, 300);
  CHECK(of(trajectory_segments(estimates, truth, {}), "10 s").segments == 41);
  estimates.erase(estimates.begin() + 150);
  // Begins at 0, 0.5, ... 5 s before the gap, and, still every fifth, at 15.1 to 19.6 s after it.
  CHECK(of(trajectory_segments(estimates, truth, {}), "10 s").segments == 11 + 10);
  const auto none = trajectory_segments({}, truth, {});
  CHECK(of(none, "50 m").segments == 0);
  CHECK(std::isnan(of(none, "50 m").anees));
}

TEST_CASE("Motions of two degrees of freedom are chained in three") {
  const Circle circle;
  Random random(26, 0);
  auto estimates = circle.estimates(kStepUs, 100, covariance(), random);
  for (RecordedEstimate& estimate : estimates) {
    estimate.motion.y() = 0.0;
    estimate.covariance(1, 1) = 0.0;
  }
  const auto all = trajectory_segments(estimates, exact_truth(circle, 100), {});
  CHECK(std::isfinite(of(all, "1 s").anees));
  CHECK(of(all, "1 s").nees.y() > 0.0);
}
