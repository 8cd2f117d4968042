// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/scan/degrees.hpp"
#include "tools/eval/drive/path_drift.hpp"

using namespace cremed;

namespace {

/// Steps of a drive: true and estimated motion.
struct DriveSteps {
  Eigen::Vector3d truth;
  Eigen::Vector3d estimate;
  int steps = 0;
};

std::vector<PathPose> path_of(const DriveSteps& drive) {
  std::vector<PathPose> path{{0, {3.0, 4.0, 2.0}, {3.0, 4.0, 2.0}, 0.0, 0}};
  for (int i = 0; i < drive.steps; ++i) {
    PathPose pose = path.back();
    pose.truth = moved(pose.truth, drive.truth);
    pose.estimate = moved(pose.estimate, drive.estimate);
    pose.driven_m += drive.truth.head<2>().norm();
    path.push_back(pose);
  }
  return path;
}

/// Steps of 0.25 m: the first pose beyond 10 m is at 10.25 m.
constexpr double kStepM = 0.25;

}  // namespace

TEST_CASE("An error of scale of 1 % is a drift of 1 % at every length") {
  const auto drifts = path_drift(path_of({{kStepM, 0.0, 0.0}, {1.01 * kStepM, 0.0, 0.0}, 600}));
  REQUIRE(drifts.size() == 10);
  for (std::size_t i = 0; i < drifts.size(); ++i) {
    const double length_m = 10.0 * static_cast<double>(i + 1);
    CAPTURE(length_m);
    CHECK(drifts[i].length_m == length_m);
    CHECK(drifts[i].translation_percent == Approx(1.0).epsilon(1e-9));
    CHECK(drifts[i].rotation_deg_per_m == Approx(0.0).margin(1e-9));
    // Each of the 601 poses begins one but for those with no more than the length before them.
    CHECK(drifts[i].segments == 601 - static_cast<std::size_t>(length_m / kStepM) - 1);
    CHECK(drifts[i].across_gaps == 0);
  }
}

TEST_CASE("A constant error of yaw on a straight road bends the path into an arc") {
  const double yaw_per_step_rad = 1e-4;
  const auto drifts =
      path_drift(path_of({{kStepM, 0.0, 0.0}, {kStepM, 0.0, yaw_per_step_rad}, 600}));
  const double per_m_rad = yaw_per_step_rad / kStepM;
  for (const PathDrift& drift : drifts) {
    CAPTURE(drift.length_m);
    CHECK(drift.rotation_deg_per_m == Approx(kDegPerRad * per_m_rad).epsilon(1e-9));
    // n steps, each turned by a little more than the one before, end at a chord of the circle.
    const double n = drift.length_m / kStepM + 1.0;
    const double chord_m =
        kStepM * std::sin(0.5 * n * yaw_per_step_rad) / std::sin(0.5 * yaw_per_step_rad);
    const double direction_rad = 0.5 * (n - 1.0) * yaw_per_step_rad;
    const double error_m = std::hypot(n * kStepM - chord_m * std::cos(direction_rad),
                                      chord_m * std::sin(direction_rad));
    CHECK(drift.translation_percent == Approx(100.0 * error_m / (n * kStepM)).epsilon(1e-6));
    CHECK(drift.translation_percent == Approx(50.0 * per_m_rad * drift.length_m).epsilon(1e-3));
  }
}

TEST_CASE("In bends too, a true estimate does not drift and errors are seen from the vehicle") {
  const Eigen::Vector3d bend{kStepM, 0.0, 0.01};
  const auto still = path_drift(path_of({bend, bend, 600}));
  CHECK(mean_drift(still).translation_percent == Approx(0.0).margin(1e-9));
  // All chords of the circle are 1 % longer, including those across it.
  const auto wide = path_drift(path_of({bend, {1.01 * kStepM, 0.0, 0.01}, 600}));
  const double half_turn_rad = 0.5 * (20.0 + kStepM) / kStepM * 0.01;
  CHECK(wide[1].translation_percent ==
        Approx(std::sin(half_turn_rad) / half_turn_rad).epsilon(1e-4));
}

TEST_CASE("Segments across a gap are left out and counted") {
  auto path = path_of({{kStepM, 0.0, 0.0}, {kStepM, 0.0, 0.0}, 100});
  for (std::size_t i = 60; i < path.size(); ++i) {
    path[i].gaps = 1;
    path[i].estimate.y_m += 5.0;
  }
  const auto drifts = path_drift(path);
  // They end 41 poses after their begin: 0 to 18 before the gap, 60 onwards have no end.
  CHECK(drifts[0].segments == 19);
  CHECK(drifts[0].across_gaps == 41);
  CHECK(drifts[0].translation_percent == Approx(0.0).margin(1e-9));
  CHECK(drifts[1].segments == 0);
  CHECK(drifts[1].across_gaps == 20);
  CHECK(std::isnan(drifts[1].translation_percent));
  CHECK(mean_drift(drifts).segments == 19);
  CHECK(mean_drift(drifts).across_gaps == 61);
}

TEST_CASE("The mean is over segments, not over lengths") {
  const auto drifts = path_drift(path_of({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.001}, 21}));
  REQUIRE(drifts[0].segments == 11);
  REQUIRE(drifts[1].segments == 1);
  CHECK(mean_drift(drifts).translation_percent ==
        Approx((11.0 * drifts[0].translation_percent + drifts[1].translation_percent) / 12.0));
}

TEST_CASE("A path that is too short has no drift") {
  for (const auto& path : {std::vector<PathPose>{}, path_of({{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, 9}),
                           path_of({{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 10})}) {
    const PathDrift mean = mean_drift(path_drift(path));
    CHECK(mean.segments == 0);
    CHECK(std::isnan(mean.translation_percent));
    CHECK(std::isnan(mean.rotation_deg_per_m));
  }
}
