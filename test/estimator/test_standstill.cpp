// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "test/estimator/drive.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Drive;
using simulation::kFront;
using simulation::options_at;

/// The motion that the estimator returns for the second of two scans.
EgoMotion estimate_at(const Pose2& mount, Drive drive) {
  const auto estimator = std::make_unique<EgoMotionEstimator>(options_at(mount));
  estimator->update(drive.next());
  return estimator->update(drive.next());
}

TEST_CASE("standing still is distinguished from moving for every mount") {
  struct Row {
    std::string what;
    Eigen::Vector3d velocity;
    Pose2 mount;
    MotionStatus status;
  };
  const Pose2 centre{};
  const Pose2 left{0.0, 0.0, radians(90.0)};
  const std::vector<Row> rows = {
      {"standing", {0.0, 0.0, 0.0}, kFront, MotionStatus::standing_still},
      {"standing, looking left", {0.0, 0.0, 0.0}, left, MotionStatus::standing_still},
      {"creeping", {0.3, 0.0, 0.0}, kFront, MotionStatus::ok},
      {"backing", {-0.5, 0.0, 0.0}, kFront, MotionStatus::ok},
      {"driving", {10.0, 0.0, 0.0}, kFront, MotionStatus::ok},
      {"driving, looking left", {10.0, 0.0, 0.0}, left, MotionStatus::ok},
      // The radar is in the centre of the turn: every Doppler is zero.
      {"turning on the spot", {0.0, 0.0, 0.3}, centre, MotionStatus::ok},
      {"turning the other way", {0.0, 0.0, -0.3}, centre, MotionStatus::ok},
  };
  for (const Row& row : rows) {
    CAPTURE(row.what);
    Drive drive(row.velocity, row.mount);
    drive.set_noise({0.02, 0.001, 0.02});
    const EgoMotion motion = estimate_at(row.mount, drive);
    CHECK(motion.status == row.status);
    const Eigen::Vector3d error = motion.motion - drive.motion_per_period();
    CHECK(numeric::normalised_error(error, motion.covariance, 2) < 25.0);
  }
}

TEST_CASE("targets abeam without Doppler are no standstill") {
  // A radar to the left with a narrow field of view, in which all Doppler is small.
  const Pose2 left{2.0, 0.8, radians(90.0)};
  Drive drive({0.5, 0.0, 0.0}, left, 3, 1500);
  drive.set_noise({0.02, 0.0005, 0.2});
  drive.set_half_view(radians(4.0));
  const EgoMotion motion = estimate_at(left, drive);
  CHECK(motion.status == MotionStatus::ok);
  CHECK(std::sqrt(motion.covariance(0, 0)) < 0.011);  // precise enough for a standstill
  CHECK(motion.motion.x() == Approx(0.05).margin(0.02));
}

TEST_CASE("a scan with only moving targets is no standstill") {
  EgoMotionOptions options = options_at(kFront);
  options.registration.doppler.enabled = false;
  for (const double approach_mps : {-0.5, 0.5, 0.0}) {
    Drive drive({0.0, 0.0, 0.0}, kFront);
    drive.set_noise({0.02, 0.001, 0.02});
    const auto estimator = std::make_unique<EgoMotionEstimator>(options);
    estimator->update(drive.next());
    RadarScan scan = drive.next();
    for (Detection& detection : scan.detections) {
      detection.doppler_mps += approach_mps;
    }
    CHECK(estimator->update(scan).status ==
          (approach_mps == 0.0 ? MotionStatus::standing_still : MotionStatus::ambiguous));
  }
}

}  // namespace
}  // namespace cremed
