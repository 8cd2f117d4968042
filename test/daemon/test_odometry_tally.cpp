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
    const auto finding = unusable_odometry(tally_of(800, status, 200));
    REQUIRE(finding);
    CHECK(finding->severity == Severity::warning);
    CHECK_THAT(finding->what, Catch::Contains("20.0 %"));
    CHECK_THAT(finding->remedy, Catch::Contains("cremed-report"));
    CHECK_FALSE(unusable_odometry(tally_of(950, status, 50)));
    CHECK_FALSE(unusable_odometry(tally_of(20, status, 20)));
  }
  CHECK_FALSE(unusable_odometry(tally_of(500, OdometryStatus::predicted, 500)));
  CHECK_FALSE(unusable_odometry(OdometryTally()));
}

}  // namespace
}  // namespace cremed
