// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/scan/two_worlds.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "test/estimator/drive.hpp"

namespace cremed {
namespace {

using simulation::Drive;
using simulation::kFront;
using simulation::options_at;

/// One radar that sees the targets of two drives.
RadarScan merged(RadarScan scan, const RadarScan& other) {
  for (std::size_t i = 0; i < other.count; ++i) {
    scan.detections[scan.count++] = other.detections[i];
  }
  return scan;
}

/// Adds targets `spacing_m` from each other, relative to which the vehicle drives ahead.
void add_row(TargetSet& targets, int count, double speed_mps, double azimuth_rad, double range_m,
             double spacing_m) {
  for (int i = 0; i < count; ++i) {
    Detection detection;
    detection.range_m = range_m + spacing_m * i;
    detection.azimuth_rad = azimuth_rad;
    detection.doppler_mps = -speed_mps * std::cos(azimuth_rad);
    detection.range_std_m = 0.15;
    detection.azimuth_std_rad = 0.008;
    detection.doppler_std_mps = 0.1;
    targets.add(detection, Pose2{});
  }
}

void add_places(TargetSet& targets, int places, double speed_mps, double azimuth_rad) {
  add_row(targets, places, speed_mps, azimuth_rad, 8.0, 4.0);
}

TEST_CASE("two worlds are ambiguous until one is gone, unless the last motion decides") {
  struct Row {
    std::string what;
    Eigen::Vector3d road;
    int scans_before;  // of the road only
    MotionStatus status;
  };
  const std::vector<Row> rows = {
      {"from the start", {8.0, 0.0, 0.0}, 0, MotionStatus::ambiguous},
      {"the last motion decides", {8.0, 0.0, 0.0}, 2, MotionStatus::ok},
      {"similar speeds, it does not", {0.8, 0.0, 0.0}, 2, MotionStatus::ambiguous},
  };
  for (const Row& row : rows) {
    CAPTURE(row.what);
    const auto estimator = std::make_unique<EgoMotionEstimator>(options_at(kFront));
    Drive road(row.road, kFront, 5, 150);
    Drive jam(Eigen::Vector3d::Zero(), kFront, 6, 80);
    for (int i = 0; i < row.scans_before; ++i) {
      jam.next();
      estimator->update(road.next());
    }
    EgoMotion motion;
    for (int i = 0; i < 3; ++i) {
      motion = estimator->update(merged(road.next(), jam.next()));
    }
    CHECK(motion.status == row.status);
    for (int i = 0; i < 12; ++i) {
      motion = estimator->update(road.next());
    }
    CHECK(motion.status == MotionStatus::ok);
    CHECK(motion.motion.x() == Approx(row.road.x() * Drive::kPeriodS).margin(0.03));
  }
}

TEST_CASE("at the start a speed that more places contradict is in doubt, whatever began before") {
  TargetSet targets;
  add_places(targets, 10, 0.0, 0.2);
  const auto is_slow = [](double speed_mps) { return std::abs(speed_mps) < 1.0; };
  using Before = TwoWorlds::Before;
  const auto is_in_doubt = [&](Before before) {
    return TwoWorlds(Pose2{}).check(targets, Eigen::Vector3d::Zero(), 0.0, before, is_slow);
  };
  CHECK_FALSE(is_in_doubt(Before::first_scans));
  add_places(targets, 9, 16.0, -0.2);
  CHECK_FALSE(is_in_doubt(Before::first_scans));
  add_places(targets, 9, 16.0, -0.5);
  CHECK(is_in_doubt(Before::first_scans));
  CHECK_FALSE(is_in_doubt(Before::motion));
}

TEST_CASE("before a motion is known a slower rival is in doubt, after a loss every rival") {
  TargetSet targets;
  using Before = TwoWorlds::Before;
  const auto is_in_doubt = [&](double speed_mps, Before before) {
    return TwoWorlds(Pose2{}).check(targets, Eigen::Vector3d(speed_mps, 0.0, 0.0), 0.0, before,
                                    [&](double other_mps) { return other_mps == speed_mps; });
  };
  add_places(targets, 10, 0.0, 0.2);
  add_places(targets, 9, 8.0, -0.2);
  CHECK_FALSE(is_in_doubt(0.0, Before::first_scans));
  CHECK(is_in_doubt(0.0, Before::fault));
  CHECK_FALSE(is_in_doubt(0.0, Before::motion));
  add_places(targets, 9, 8.0, -0.5);
  CHECK(is_in_doubt(8.0, Before::first_scans));
  CHECK(is_in_doubt(8.0, Before::fault));
  CHECK_FALSE(is_in_doubt(8.0, Before::motion));
}

TEST_CASE("what rests beside a parked vehicle has a share of the targets, but not beside a truck") {
  using Before = TwoWorlds::Before;
  const auto is_in_doubt = [](int passing_places, int resting) {
    TargetSet targets;
    for (int place = 0; place < passing_places; ++place) {
      add_row(targets, 100 / passing_places, 18.0, 0.0, 10.0 + 5.0 * place, 0.02);
    }
    add_places(targets, resting, 0.0, 0.4);
    return TwoWorlds(Pose2{}).check(targets, Eigen::Vector3d(18.0, 0.0, 0.0), 0.0,
                                    Before::first_scans, [](double) { return true; });
  };
  CHECK_FALSE(is_in_doubt(20, 14));  // Guard rails, and cars that drive along.
  CHECK(is_in_doubt(20, 16));
  CHECK(is_in_doubt(4, 5));  // A truck that passes.
}

TEST_CASE("of a lone radar that looks sideways six places along the way tell the road") {
  using Before = TwoWorlds::Before;
  const auto is_in_doubt = [&](TwoWorlds& worlds, int places, Before before) {
    TargetSet targets;
    add_places(targets, places, 5.0, 0.2);
    return worlds.check(targets, Eigen::Vector3d(5.0, 0.0, 0.0), 0.0, before,
                        [](double) { return true; });
  };
  TwoWorlds worlds(Pose2{});
  CHECK_FALSE(is_in_doubt(worlds, 5, Before::first_scans));
  CHECK_FALSE(is_in_doubt(worlds, 6, Before::first_scans_lone_side_radar));
  CHECK(is_in_doubt(worlds, 5, Before::first_scans_lone_side_radar));
  // It lasts for ten scans, and does not count where another radar is heard or the motion is known.
  for (int i = 0; i < 9; ++i) {
    CHECK(is_in_doubt(worlds, 6, Before::first_scans_lone_side_radar));
  }
  CHECK_FALSE(is_in_doubt(worlds, 5, Before::first_scans));
  CHECK_FALSE(is_in_doubt(worlds, 5, Before::motion));
  CHECK_FALSE(is_in_doubt(worlds, 6, Before::first_scans_lone_side_radar));
}

}  // namespace
}  // namespace cremed
