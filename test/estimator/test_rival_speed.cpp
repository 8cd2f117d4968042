// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/scan/rival_speed.hpp"

namespace cremed {
namespace {

const Pose2 kAheadMount{3.4, 0.5, 0.0};
constexpr double kDopplerStdMps = 0.1;

/// Adds `count` targets on an arc ahead, `spacing_m` apart, that are static if the vehicle's
/// velocity is `velocity`.
void add_targets(TargetSet& targets, int count, double range_m, double spacing_m,
                 const Eigen::Vector3d& velocity, double first_azimuth_rad = -0.8) {
  for (int i = 0; i < count; ++i) {
    Detection detection;
    detection.range_m = range_m;
    detection.azimuth_rad = first_azimuth_rad + i * spacing_m / range_m;
    const double x_mps = velocity.x() - velocity.z() * kAheadMount.y_m;
    const double y_mps = velocity.y() + velocity.z() * kAheadMount.x_m;
    detection.doppler_mps =
        -x_mps * std::cos(detection.azimuth_rad) - y_mps * std::sin(detection.azimuth_rad);
    detection.range_std_m = 0.2;
    detection.azimuth_std_rad = 0.01;
    detection.doppler_std_mps = kDopplerStdMps;
    targets.add(detection, kAheadMount);
  }
}

}  // namespace

TEST_CASE("A static target gives the vehicle's speed also in turns and skids") {
  for (const Eigen::Vector3d& velocity :
       {Eigen::Vector3d(8.0, 0.0, 0.0), Eigen::Vector3d(-3.0, 0.0, 0.4),
        Eigen::Vector3d(10.0, -2.0, -0.3)}) {
    CAPTURE(velocity.transpose());
    TargetSet targets;
    add_targets(targets, 20, 40.0, 3.0, velocity);
    for (const Target& target : targets) {
      CHECK(speed_along_x_mps(target, velocity, kAheadMount) == Approx(velocity.x()));
    }
  }
}

TEST_CASE("Two worlds are counted by their places, with the rival's speed") {
  struct Row {
    const char* what;
    int own;
    int others;
    double spacing_m;  ///< Of the rival's targets.
    std::size_t rival;
  };
  const std::vector<Row> rows = {
      {"one world", 20, 0, 4.0, 0},
      {"a few at another speed", 20, 4, 4.0, 4},
      {"a car shows many targets and is one place", 20, 6, 0.5, 1},
      {"more of the rival's world", 5, 12, 4.0, 12},
  };
  const Eigen::Vector3d own(2.0, 0.0, 0.2);
  const Eigen::Vector3d other(6.0, 0.0, 0.2);
  for (const Row& row : rows) {
    CAPTURE(row.what);
    TargetSet targets;
    add_targets(targets, row.own, 60.0, 4.0, own);
    add_targets(targets, row.others, 40.0, row.spacing_m, other);
    RivalSpeed rival_speed(kAheadMount);
    const SpeedVotes votes = rival_speed.count(targets, own, 0.3);
    CHECK(votes.rival == row.rival);
    if (row.rival > 0) {
      CHECK(votes.own == static_cast<std::size_t>(row.own));
      CHECK(votes.rival_mps == Approx(6.0).margin(0.01));
    }
  }
}

TEST_CASE("Braking does not make a rival of the vehicle's mean speed") {
  TargetSet targets;
  add_targets(targets, 12, 60.0, 4.0, {9.0, 0.0, 0.0}, -0.35);
  RivalSpeed rival_speed(kAheadMount);
  const Eigen::Vector3d mean(9.5, 0.0, 0.0);
  CHECK(rival_speed.count(targets, mean, 0.5).rival == 0);
  CHECK(rival_speed.count(targets, mean, 0.0).rival > 10);
}

TEST_CASE("Most clutter is no rival; a world in it is") {
  std::mt19937_64 random(3);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  const Eigen::Vector3d own(8.0, 0.0, 0.0);
  RivalSpeed rival_speed(kAheadMount);
  int rivals = 0;
  for (int scan = 0; scan < 200; ++scan) {
    TargetSet targets;
    add_targets(targets, 30, 60.0, 4.0, own);
    for (int i = 0; i < 60; ++i) {
      add_targets(targets, 1, uniform(5.0, 60.0), 4.0, {uniform(-12.0, 28.0), 0.0, 0.0},
                  uniform(-0.8, 0.8));
    }
    rivals += rival_speed.count(targets, own, 0.3).rival >= 5 ? 1 : 0;
    add_targets(targets, 20, 40.0, 4.0, {15.0, 0.0, 0.0});
    CHECK(rival_speed.count(targets, own, 0.3).rival >= 15);
  }
  CHECK(rivals <= 103);  // 82 of 200, and 3 sigma; without the comparison with others 130.
}

TEST_CASE("A road among cars at many speeds has more targets than these have by chance") {
  const Eigen::Vector3d own(2.0, 0.0, 0.0);
  TargetSet targets;
  add_targets(targets, 20, 60.0, 4.0, own);
  for (int i = 0; i < 30; ++i) {
    add_targets(targets, 1, 10.0 + i, 4.0, {3.0 + 0.25 * i, 0.0, 0.0}, 0.05 * (i - 15));
  }
  CHECK(RivalSpeed(kAheadMount).count(targets, own, 0.3).rival < 5);
  add_targets(targets, 12, 40.0, 4.0, {6.5, 0.0, 0.0});
  const SpeedVotes votes = RivalSpeed(kAheadMount).count(targets, own, 0.3);
  CHECK(votes.rival >= 12);
  CHECK(votes.rival_mps == Approx(6.5).margin(0.3));
}

TEST_CASE("Targets abeam and an empty scan have no vote") {
  TargetSet targets;
  RivalSpeed rival_speed(kAheadMount);
  CHECK(rival_speed.count(targets, Eigen::Vector3d::Zero(), 0.5).rival == 0);
  add_targets(targets, 10, 40.0, 1.5, {5.0, 0.0, 0.0}, 1.2);
  CHECK(rival_speed.count(targets, Eigen::Vector3d::Zero(), 0.5).rival == 0);
}

}  // namespace cremed
