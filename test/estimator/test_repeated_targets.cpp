// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/self_check.hpp"

namespace cremed {
namespace {

TargetSet row_of_targets(int targets, double x_m, double doppler_mps) {
  TargetSet set;
  for (int i = 0; i < targets; ++i) {
    Target target;
    target.x_m = x_m + 5.0 * i;
    target.y_m = i;
    target.covariance_m2 = {0.01, 0.0, 0.01};
    target.bearing_std_rad = 0.01;
    target.doppler_mps = doppler_mps;
    target.doppler_std_mps = 0.1;
    set.add(target);
  }
  return set;
}

bool is_repeated(const TargetSet& first, const TargetSet& second) {
  RepeatedTargets repeated;
  repeated.add(first);
  CHECK_FALSE(repeated.is_repeated());
  repeated.add(second);
  return repeated.is_repeated();
}

TEST_CASE("a scan that is the one before again is found while moving") {
  const TargetSet moving = row_of_targets(5, 10.0, -2.0);
  CHECK(is_repeated(moving, moving));
  CHECK_FALSE(is_repeated(moving, row_of_targets(5, 9.9, -2.0)));
  CHECK_FALSE(is_repeated(moving, row_of_targets(5, 10.0, -1.9)));
  CHECK_FALSE(is_repeated(moving, row_of_targets(6, 10.0, -2.0)));
}

TEST_CASE("a standing vehicle, or one that sees little, may see the same twice") {
  CHECK_FALSE(is_repeated(row_of_targets(5, 10.0, 0.0), row_of_targets(5, 10.0, 0.0)));
  CHECK_FALSE(is_repeated(row_of_targets(4, 10.0, -2.0), row_of_targets(4, 10.0, -2.0)));
  CHECK_FALSE(is_repeated({}, {}));
}

TEST_CASE("a sensor that hangs at rest is found after ten repeats, and no longer when it goes on") {
  const TargetSet standing = row_of_targets(5, 10.0, 0.0);
  RepeatedTargets repeated;
  repeated.add(standing);
  for (int i = 1; i < 10; ++i) {
    repeated.add(standing);
    CHECK_FALSE(repeated.is_repeated());
  }
  for (int i = 0; i < 3; ++i) {
    repeated.add(standing);
    CHECK(repeated.is_repeated());
  }
  repeated.add(row_of_targets(5, 10.2, 0.0));
  CHECK_FALSE(repeated.is_repeated());
  repeated.add(row_of_targets(5, 10.2, 0.0));
  CHECK_FALSE(repeated.is_repeated());
}

TEST_CASE("a radar that repeats is doubted at once, and no longer when it does not") {
  const bool is_aside = GENERATE(false, true);
  EgoMotionOptions options;
  options.vehicle_from_radar.yaw_rad = is_aside ? 1.57 : 0.0;
  SelfCheck check(options);
  EgoMotion motion;
  const auto doubts_after = [&](double x_m) {
    motion.utime_start_us = motion.utime_us;
    motion.utime_us += 75'000;
    check.add(motion, row_of_targets(5, x_m, -2.0));
    return check.doubts();
  };
  CHECK(doubts_after(10.0) == 0);
  CHECK(doubts_after(9.85) == 0);
  CHECK(doubts_after(9.85) == positions_contradict_speed);
  CHECK(doubts_after(9.85) == positions_contradict_speed);
  CHECK(doubts_after(9.40) == 0);
}

}  // namespace
}  // namespace cremed
