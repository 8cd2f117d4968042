// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/speed_check.hpp"
#include "test/estimator/circle_drive.hpp"
#include "test/estimator/simulation.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// The check after some seconds of the drive.
class SpeedCheckedDrive {
 public:
  void go_on(const CircleDrive& drive, double duration_s) {
    view_.go_on(drive, duration_s, [&](const TargetSet& targets, double, std::int64_t stamp_us) {
      check.add(targets, stamp_us);
    });
  }

  SpeedCheck check;

 private:
  CircleView view_;
};

}  // namespace

TEST_CASE("Speed check: correct data are checked and raise no doubt at any speed") {
  const double speed_mps = GENERATE(-5.0, 0.0, 1.0, 5.0, 12.0, 25.0, 35.0);
  const double yaw_rate_radps = GENERATE(-0.3, 0.0, 0.15);
  CAPTURE(speed_mps, yaw_rate_radps);
  SpeedCheckedDrive drive;
  for (int second = 0; second < 20; ++second) {
    drive.go_on({.speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps}, 1.0);
    CHECK_FALSE(drive.check.is_contradicted());
  }
  CHECK(drive.check.is_checked());
}

TEST_CASE("Speed check: posts of guard rails that repeat raise no doubt") {
  const double speed_mps = GENERATE(10.0, 14.7, 20.0, 30.0);
  const double post_spacing_m = GENERATE(2.0, 3.0, 4.0);
  CAPTURE(speed_mps, post_spacing_m);
  SpeedCheckedDrive drive;
  for (int second = 0; second < 20; ++second) {
    drive.go_on({.speed_mps = speed_mps, .things = 1000, .post_spacing_m = post_spacing_m}, 1.0);
    CHECK_FALSE(drive.check.is_contradicted());
  }
  CHECK(drive.check.is_checked());
}

TEST_CASE("Speed check: traffic that drives along is no evidence against the Doppler") {
  TargetSet traffic;
  for (int k = 0; k < 26; ++k) {
    Detection detection;
    detection.range_m = 10.0 + 1.5 * (k % 13);
    detection.azimuth_rad = k < 13 ? -0.3 : 0.3;
    detection.range_std_m = 0.15;
    detection.azimuth_std_rad = 0.008;
    detection.doppler_std_mps = 0.1;
    traffic.add(detection, CircleDrive().mount);
  }
  SpeedCheck check;
  CircleView view;
  const auto add = [&](TargetSet targets, double, std::int64_t stamp_us) {
    for (const Target& target : traffic) targets.add(target);
    check.add(targets, stamp_us);
    CHECK_FALSE(check.is_contradicted());
  };
  view.go_on({.things = 4500, .kept = 0.4}, 10.0, add);
  CHECK(check.is_checked());
}

TEST_CASE("Speed check: walls that reflect at other points in each scan raise no doubt") {
  simulation::Random random(static_cast<std::uint64_t>(GENERATE(range(1, 41))));
  std::normal_distribution<double> error_m(0.0, 0.15);
  SpeedCheck check;
  for (int scan = 0; scan < 600; ++scan) {
    TargetSet walls;
    for (int k = 0; k < 30; ++k) {
      const double x_m = simulation::uniform(random, 5.0, 60.0);
      const double y_m = k % 2 == 0 ? 4.0 : -4.0;
      Detection detection;
      detection.range_m = std::hypot(x_m, y_m) + error_m(random);
      detection.azimuth_rad = std::atan2(y_m, x_m);
      detection.range_std_m = 0.15;
      detection.azimuth_std_rad = 0.005;
      detection.doppler_mps = -17.0 * std::cos(detection.azimuth_rad);
      detection.doppler_std_mps = 0.1;
      walls.add(detection, Pose2{});
    }
    check.add(walls, 100'000 * scan);
    REQUIRE_FALSE(check.is_contradicted());
  }
}

TEST_CASE("Speed check: stuck Doppler is detected within 1.5 s of driving, its end at once") {
  const double speed_mps = GENERATE(-5.0, 4.0, 10.0, 25.0);
  const double yaw_rate_radps = GENERATE(-0.3, 0.0, 0.15);
  CAPTURE(speed_mps, yaw_rate_radps);
  const CircleDrive healthy{.speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps};
  CircleDrive stuck = healthy;
  stuck.doppler_factor = 0.0;
  SpeedCheckedDrive drive;
  drive.go_on(healthy, 3.0);
  drive.go_on(stuck, 1.5);
  CHECK(drive.check.is_contradicted());
  drive.go_on(healthy, kPeriodS);
  CHECK_FALSE(drive.check.is_contradicted());
}

TEST_CASE("Speed check: a doubt lasts where nothing can be compared, and ends soon after") {
  SpeedCheckedDrive drive;
  drive.go_on({}, 3.0);
  drive.go_on({.doppler_factor = 0.0}, 1.5);
  REQUIRE(drive.check.is_contradicted());
  drive.go_on({.things = 0}, 60.0);
  CHECK(drive.check.is_contradicted());
  CHECK_FALSE(drive.check.is_checked());
  drive.go_on({}, 3.0);
  CHECK_FALSE(drive.check.is_contradicted());
}

TEST_CASE("Speed check: stamps at half or twice the rate of time are detected within 2 s") {
  const double pace = GENERATE(0.5, 2.0);
  const double speed_mps = GENERATE(5.0, 12.0);
  CAPTURE(pace, speed_mps);
  SpeedCheckedDrive drive;
  drive.go_on({.speed_mps = speed_mps, .pace = pace}, 2.0);
  CHECK(drive.check.is_contradicted());
}

TEST_CASE("Speed check: without matches there is no verdict and no doubt") {
  const auto drive =
      GENERATE(CircleDrive{.things = 0}, CircleDrive{.things = 60}, CircleDrive{.kept = 0.02});
  SpeedCheckedDrive checked;
  checked.go_on(drive, 20.0);
  CHECK_FALSE(checked.check.is_contradicted());
  CHECK_FALSE(checked.check.is_checked());
}

TEST_CASE("Speed check: pauses, stamps that go back and a set clock give no verdict") {
  SpeedCheckedDrive drive;
  drive.go_on({}, 3.0);
  drive.go_on({.pace = 40.0}, 0.3);
  drive.go_on({.pace = -40.0}, 0.3);
  drive.check.forget();
  CHECK_FALSE(drive.check.is_contradicted());
  drive.go_on({}, 3.0);
  CHECK_FALSE(drive.check.is_contradicted());
  CHECK(drive.check.is_checked());
}
