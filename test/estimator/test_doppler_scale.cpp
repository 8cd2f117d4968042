// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/doppler_scale.hpp"
#include "test/estimator/circle_drive.hpp"
#include "test/estimator/simulation.hpp"

using namespace cremed;
using namespace cremed::test;
using cremed::simulation::kFront;

namespace {

const Pose2 kBackLeft{-0.6, 0.6, std::numbers::pi - 0.1};

/// The check after some seconds of the drive.
class ScaleCheckedDrive {
 public:
  explicit ScaleCheckedDrive(const Pose2& mount = kFront) : check(mount), mount_(mount) {}

  void go_on(CircleDrive drive, double duration_s) {
    drive.mount = mount_;
    view_.go_on(drive, duration_s,
                [&](const TargetSet& targets, double yaw_rate_radps, std::int64_t stamp_us) {
                  check.add(targets, yaw_rate_radps, stamp_us);
                });
  }

  DopplerScale check;

 private:
  CircleView view_;
  Pose2 mount_;
};

}  // namespace

TEST_CASE("Doppler scale: a right one is not doubted, and known to 2 %") {
  const double speed_mps = GENERATE(-5.0, 0.0, 1.0, 3.0, 12.0, 25.0, 35.0);
  const double yaw_rate_radps = GENERATE(-0.3, 0.0, 0.15);
  const Pose2 mount = GENERATE(kFront, kBackLeft);
  CAPTURE(speed_mps, yaw_rate_radps, mount.x_m);
  ScaleCheckedDrive drive(mount);
  for (int second = 0; second < 20; ++second) {
    drive.go_on({.speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps}, 1.0);
    CHECK_FALSE(drive.check.is_wrong());
  }
  CHECK(drive.check.correction() == Approx(1.0).margin(0.025));
}

TEST_CASE(
    "Doppler scale: one that is 5 % or more off is found in 2 s, 10 % in a turn, and its end") {
  const double scale = GENERATE(0.62, 0.7, 0.8, 0.9, 0.95, 1.06, 1.1, 1.25, 1.55);
  const double speed_mps = GENERATE(-5.0, 5.0, 12.0, 25.0);
  const double yaw_rate_radps = GENERATE(-0.2, 0.0);
  const Pose2 mount = GENERATE(kFront, kBackLeft);
  CAPTURE(scale, speed_mps, yaw_rate_radps, mount.x_m);
  if (std::abs(scale - 1.0) < 0.07 && std::abs(yaw_rate_radps / speed_mps) > 0.02) {
    return;  // Healthy radars have as much there.
  }
  const CircleDrive healthy{.speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps};
  CircleDrive faulty = healthy;
  faulty.doppler_factor = scale;
  ScaleCheckedDrive drive(mount);
  drive.go_on(faulty, 2.0);
  CHECK(drive.check.is_wrong());
  drive.go_on(faulty, 3.0);
  CHECK(drive.check.correction() == Approx(1.0 / scale).margin(0.025));
  drive.go_on(healthy, 4.0);
  CHECK_FALSE(drive.check.is_wrong());
}

TEST_CASE("Doppler scale: a wrong sign is found in 2 s, and its end too") {
  const double speed_mps = GENERATE(-5.0, 5.0, 12.0, 25.0);
  const double yaw_rate_radps = GENERATE(-0.2, 0.0);
  const Pose2 mount = GENERATE(kFront, kBackLeft);
  CAPTURE(speed_mps, yaw_rate_radps, mount.x_m);
  const CircleDrive healthy{.speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps};
  CircleDrive faulty = healthy;
  faulty.doppler_factor = -1.0;
  ScaleCheckedDrive drive(mount);
  drive.go_on(healthy, 5.0);
  drive.go_on(faulty, 2.0);
  CHECK(drive.check.is_wrong());
  CHECK(drive.check.correction() == -1.0);
  drive.go_on(healthy, 2.0);
  CHECK_FALSE(drive.check.is_wrong());
}

TEST_CASE("Doppler scale: open for a second of driving, and again if Doppler jumps") {
  ScaleCheckedDrive drive;
  drive.go_on({.speed_mps = 0.0}, 2.0);
  CHECK_FALSE(drive.check.is_open());
  drive.go_on({.speed_mps = 8.0}, 0.5);
  CHECK(drive.check.is_open());
  drive.go_on({.speed_mps = 8.0}, 1.5);
  CHECK_FALSE(drive.check.is_open());
  drive.go_on({.speed_mps = 8.0, .doppler_factor = 1.15}, 0.5);
  CHECK(drive.check.is_open());
  drive.go_on({.speed_mps = 8.0, .doppler_factor = 1.15}, 1.5);
  CHECK_FALSE(drive.check.is_open());
  CHECK(drive.check.is_wrong());
}

TEST_CASE("Doppler scale: not open for ever where scans cannot be compared") {
  ScaleCheckedDrive drive;
  drive.go_on({.speed_mps = GENERATE(1.52, 1.7)}, 6.0);
  CHECK_FALSE(drive.check.is_open());
  CHECK_FALSE(drive.check.is_wrong());
}

TEST_CASE("Doppler scale: once acquitted it is not doubted, until the votes say so again") {
  ScaleCheckedDrive drive;
  const CircleDrive faulty{.speed_mps = 12.0, .doppler_factor = 0.9};
  drive.go_on(faulty, 2.0);
  REQUIRE(drive.check.is_wrong());
  drive.check.acquit();
  CHECK_FALSE(drive.check.is_wrong());
  drive.go_on(faulty, 0.1);
  CHECK_FALSE(drive.check.is_wrong());
  drive.go_on(faulty, 2.0);
  CHECK(drive.check.is_wrong());
}

TEST_CASE("Doppler scale: without matches nothing is known, and nothing doubted") {
  const auto drive = GENERATE(CircleDrive{.doppler_factor = 0.9, .things = 0},
                              CircleDrive{.doppler_factor = 0.9, .kept = 0.02});
  ScaleCheckedDrive checked;
  checked.go_on(drive, 20.0);
  CHECK_FALSE(checked.check.is_wrong());
}

TEST_CASE("Doppler scale: pauses, stamps that go back and a set clock raise no doubt") {
  ScaleCheckedDrive drive;
  drive.go_on({}, 3.0);
  drive.go_on({.pace = 40.0}, 0.3);
  drive.go_on({.pace = -40.0}, 0.3);
  CHECK_FALSE(drive.check.is_wrong());
  drive.check.forget();
  drive.go_on({}, 3.0);
  CHECK_FALSE(drive.check.is_wrong());
}
