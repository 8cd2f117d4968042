// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "test/tools/circle.hpp"
#include "tools/eval/chi_square.hpp"
#include "tools/eval/drive/motion_chain.hpp"
#include "tools/eval/drive/pose_windows.hpp"
#include "tools/eval/drive/trajectory_segments.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

Eigen::Matrix3d diagonal_covariance() {
  return Eigen::Vector3d(0.01, 0.005, 0.001).cwiseAbs2().asDiagonal();
}

std::vector<SegmentErrors> segments_of(const RecordedOdometry& odometry,
                                       const TrueTrajectory& truth, const TruthNoise& noise = {}) {
  return trajectory_segments(odometry, truth, noise, first_window_us({odometry}, truth));
}

std::vector<SegmentErrors> segments_of(const std::vector<RecordedEstimate>& estimates,
                                       const TrueTrajectory& truth, const TruthNoise& noise = {}) {
  return segments_of(RecordedOdometry{"front", estimates, 0}, truth, noise);
}

const SegmentErrors& of(const std::vector<SegmentErrors>& all, const std::string& length) {
  for (const SegmentErrors& errors : all) {
    if (to_text(errors.length) == length) return errors;
  }
  throw std::invalid_argument("no such length");
}

/// The number of segments without overlap determines the accuracy of a mean.
void check_mean_is_one(double nees, double apart, int degrees_of_freedom) {
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
  const auto steps = circle.estimates(kStepUs, kSteps, diagonal_covariance(), random);
  const bool anchored = rows_per_anchor != 0;
  const auto all =
      anchored ? segments_of(
                     RecordedOdometry{"odometry", since_anchors(steps, rows_per_anchor), 0, steps},
                     exact_truth(circle, kSteps))
               : segments_of(steps, exact_truth(circle, kSteps));
  REQUIRE(all.size() == 7);
  const std::size_t begins = rows_per_anchor == 0 ? kSteps / 5 : kSteps / rows_per_anchor;
  for (const SegmentErrors& errors : all) {
    CAPTURE(to_text(errors.length), errors.segments, errors.chains);
    const double seconds = std::min(errors.length.time_s, errors.length.way_m / 8.0);
    CHECK(errors.chains > begins - 62);
    CHECK(errors.chains <= begins);
    // Windows begin 0.5 s apart, with anchors too.
    const bool by_time = errors.length.time_s < 1e9;
    const auto windows = static_cast<std::size_t>((2000.0 - seconds) / 0.5);
    CHECK(errors.segments == (by_time ? windows : errors.chains));
    const double apart = std::min(1999.5 / seconds, static_cast<double>(begins));
    check_mean_is_one(errors.anees, apart, 3);
    check_mean_is_one(errors.nees.x(), apart, 1);
    check_mean_is_one(errors.nees.y(), apart, 1);
    check_mean_is_one(errors.nees.z(), apart, 1);
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
    estimate.covariance = diagonal_covariance();
  }
  const auto all = segments_of(estimates, exact_truth(circle, 400));
  // 100 motions: 0.1 rad at a sigma of 0.01.
  CHECK(of(all, "10 s").nees.z() == Approx(100.0).epsilon(1e-3));
  CHECK(of(all, "10 s").rmse.z() == Approx(0.1).epsilon(1e-3));
  CHECK(of(all, "1 s").nees.z() == Approx(10.0).epsilon(1e-3));
}

TEST_CASE("An error of scale is its share of the way; ways end at or beyond their length") {
  const Circle straight{8.0, 1e-9};
  Random random(23, 0);
  auto estimates = straight.estimates(kStepUs, 400, 1e-12 * Eigen::Matrix3d::Identity(), random);
  for (RecordedEstimate& estimate : estimates) {
    estimate.motion.x() *= 1.02;
    estimate.covariance = diagonal_covariance();
  }
  const auto all = segments_of(estimates, exact_truth(straight, 400));
  for (const SegmentErrors& errors : all) {
    CAPTURE(to_text(errors.length));
    // Of the estimated way, after a time of the true one.
    const double scale = errors.length.time_s < 1e9 ? 1.0 : 1.02;
    CHECK(errors.position_percent == Approx(100.0 * 0.02 / scale).epsilon(1e-3));
  }
  // 13 motions of 0.816 m are 10.6 m; a chain begins at 0.5, 1, ... 38.5 s.
  CHECK(of(all, "10 m").rmse.x() == Approx(13 * 0.016).epsilon(1e-3));
  CHECK(of(all, "10 m").segments == 77);
  CHECK(of(all, "30 s").segments == 20);
}

TEST_CASE("Truth's noise is added at the end, by the time that the segment takes") {
  const Circle circle;
  Random random(24, 0);
  auto estimates = circle.estimates(kStepUs, 400, 1e-12 * Eigen::Matrix3d::Identity(), random);
  for (RecordedEstimate& estimate : estimates) estimate.motion.z() += 0.001;
  const TruthNoise noise({{0.01, 0.01, 0.01, 1.0}, {0.01, 0.01, 0.1, 10.0}});
  const auto all = segments_of(estimates, exact_truth(circle, 400), noise);
  CHECK(of(all, "1 s").nees.z() == Approx(1.0).epsilon(1e-3));
  CHECK(of(all, "10 s").nees.z() == Approx(1.0).epsilon(1e-3));
}

TEST_CASE("Segments across a gap and beyond truth are left out") {
  const Circle circle;
  Random random(25, 0);
  auto estimates = circle.estimates(kStepUs, 400, diagonal_covariance(), random);
  const auto truth = exact_truth(circle, 300);
  CHECK(of(segments_of(estimates, truth), "10 s").segments == 40);
  CHECK(of(segments_of(estimates, truth), "10 s").chains == 40);
  estimates.erase(estimates.begin() + 150);
  // Begins at 0.5, 1, ... 5 s before the gap, and at 15.5 to 20 s after it; the window of 15 s has
  // its first motion at 15.1 s.
  CHECK(of(segments_of(estimates, truth), "10 s").segments == 10 + 10);
  CHECK(of(segments_of(estimates, truth), "10 s").chains == 10 + 11);
  const auto none = segments_of(std::vector<RecordedEstimate>{}, truth);
  CHECK(of(none, "50 m").segments == 0);
  CHECK(std::isnan(of(none, "50 m").anees));
}

TEST_CASE("Segments that begin or end in a gap of truth are left out") {
  const Circle circle;
  Random random(25, 0);
  const auto estimates = circle.estimates(kStepUs, 400, diagonal_covariance(), random);
  const auto all = segments_of(estimates, with_gap(exact_truth(circle, 400), 150, 159));
  // Windows: begun up to 4.5 s, or from 16 to 30 s. Chains: not those begun or ended from 15 to
  // 15.5 s.
  CHECK(of(all, "10 s").segments == 9 + 29);
  CHECK(of(all, "10 s").chains == 60 - 4);
}

TEST_CASE("A chain whose nearest row is its begin is none") {
  const Circle circle;
  Random random(28, 0);
  const auto all = segments_of(circle.estimates(3'000'000, 20, diagonal_covariance(), random),
                               exact_truth(circle, 600));
  CHECK(of(all, "1 s").chains == 0);
  CHECK(std::isnan(of(all, "1 s").anees));
  CHECK(of(all, "5 s").chains == 18);
}

TEST_CASE("Motions of two degrees of freedom are chained in three") {
  const Circle circle;
  Random random(26, 0);
  auto estimates = circle.estimates(kStepUs, 100, diagonal_covariance(), random);
  for (RecordedEstimate& estimate : estimates) {
    estimate.motion.y() = 0.0;
    estimate.covariance(1, 1) = 0.0;
  }
  const auto all = segments_of(estimates, exact_truth(circle, 100));
  CHECK(std::isfinite(of(all, "1 s").anees));
  CHECK(of(all, "1 s").nees.y() > 0.0);
}

TEST_CASE("A chain ends at the estimate nearest to its time") {
  const Circle circle;
  Random random(27, 0);
  auto estimates = circle.estimates(300'000, 100, 1e-12 * Eigen::Matrix3d::Identity(), random);
  for (RecordedEstimate& estimate : estimates) {
    estimate.motion.z() += 0.001;
    estimate.covariance = diagonal_covariance();
  }
  const auto all = segments_of(estimates, exact_truth(circle, 300));
  // An error of one sigma each: NEES of yaw is the number of motions. 0.9 s are nearer to 1 s than
  // 1.2 s are, and 5.1 s nearer to 5 s than 4.8 s.
  CHECK(of(all, "1 s").nees.z() == Approx(3.0).epsilon(1e-3));
  CHECK(of(all, "5 s").nees.z() == Approx(17.0).epsilon(1e-3));
}
