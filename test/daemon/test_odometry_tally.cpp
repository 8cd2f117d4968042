// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "daemon/report/odometry_tally.hpp"

namespace cremed {
namespace {

OdometryTally tally_of(int usable, OdometryStatus other, int others) {
  OdometryTally tally;
  Odometry odometry;
  odometry.status = OdometryStatus::ok;
  for (int i = 0; i < usable; ++i) {
    tally.on_odometry(odometry);
  }
  odometry.status = other;
  for (int i = 0; i < others; ++i) {
    tally.on_odometry(odometry);
  }
  return tally;
}

TEST_CASE(
    "an odometry that was not to be believed for a tenth of the time is told, with a remedy") {
  for (const OdometryStatus status : {OdometryStatus::ambiguous, OdometryStatus::lost}) {
    const auto finding = unusable_odometry(tally_of(800, status, 200), 2);
    REQUIRE(finding);
    CHECK(finding->severity == Severity::warning);
    CHECK_THAT(finding->what, Catch::Contains("20.0 %"));
    CHECK_THAT(finding->remedy, Catch::Contains("cremed-report"));
    CHECK_FALSE(unusable_odometry(tally_of(950, status, 50), 2));
    CHECK_FALSE(unusable_odometry(tally_of(20, status, 20), 2));
  }
  CHECK_FALSE(unusable_odometry(tally_of(500, OdometryStatus::predicted, 500), 2));
  CHECK_FALSE(unusable_odometry(OdometryTally(), 2));
}

TEST_CASE("an only radar is not told that others contradict it") {
  const auto of = [](std::size_t radars) {
    return unusable_odometry(tally_of(800, OdometryStatus::lost, 200), radars)->what;
  };
  CHECK_THAT(of(2), Catch::EndsWith("its radars contradict each other, or themselves"));
  CHECK_THAT(of(1), Catch::EndsWith("its radar contradicts itself"));
}

/// `steps` of 1 m each, the share `reversed` of them backwards.
OdometryTally driven(int steps, double reversed, double speed_mps) {
  OdometryTally tally;
  Odometry odometry;
  odometry.status = OdometryStatus::ok;
  for (int i = 0; i < steps; ++i) {
    const double sign = i < reversed * steps ? -1.0 : 1.0;
    odometry.motion.x() = sign;
    odometry.twist.x() = sign * speed_mps;
    tally.on_odometry(odometry);
  }
  return tally;
}

TEST_CASE("an odometry in reverse for all of a drive is told, if a single radar says so") {
  const auto finding = reversed_odometry(driven(100, 1.0, 13.0), 1);
  REQUIRE(finding);
  CHECK(finding->severity == Severity::note);
  CHECK(finding->what == "the vehicle drove backwards for 100.0 % of 100.0 m, at up to 13.0 m/s");
  CHECK_THAT(finding->remedy, Catch::Contains("turn mount.yaw_rad by pi"));
  CHECK_FALSE(reversed_odometry(driven(100, 1.0, 13.0), 2));
  CHECK_FALSE(reversed_odometry(driven(100, 0.8, 13.0), 1));
  CHECK_FALSE(reversed_odometry(driven(40, 1.0, 13.0), 1));
  CHECK_FALSE(reversed_odometry(driven(100, 1.0, 1.0), 1));
  CHECK_FALSE(reversed_odometry(OdometryTally(), 1));
  CHECK(odometry_findings(driven(100, 1.0, 13.0), 1).size() == 1);
  CHECK(odometry_findings(driven(100, 0.0, 13.0), 1).empty());
}

}  // namespace
}  // namespace cremed
