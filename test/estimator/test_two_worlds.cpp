// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "test/estimator/drive.hpp"

namespace cremed {
namespace {

using simulation::Drive;
using simulation::options_at;

constexpr double kPeriod = 0.1;
const Pose2 kFront{3.4, 0.0, 0.0};

/// One radar that sees the targets of two drives.
RadarScan both(RadarScan scan, const RadarScan& other) {
  for (std::size_t i = 0; i < other.count; ++i) {
    scan.detections[scan.count++] = other.detections[i];
  }
  return scan;
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
      motion = estimator->update(both(road.next(), jam.next()));
    }
    CHECK(motion.status == row.status);
    for (int i = 0; i < 12; ++i) {
      motion = estimator->update(road.next());
    }
    CHECK(motion.status == MotionStatus::ok);
    CHECK(motion.motion.x() == Approx(row.road.x() * kPeriod).margin(0.03));
  }
}

}  // namespace
}  // namespace cremed
