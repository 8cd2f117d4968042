// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <functional>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "test/estimator/drawn_vehicle.hpp"

namespace cremed {
namespace {

using simulation::drawn_options;
using simulation::drawn_radars;
using simulation::DrawnMotion;
using simulation::DrawnVehicle;

constexpr double kDurationS = 70.0;

/// A drive of one radar in bends, with motions modified before the check.
SelfCheck checked(int degrees_of_freedom,
                  const std::function<void(double time_s, EgoMotion& motion)>& alter,
                  double duration_s = kDurationS) {
  const EgoMotionOptions options = drawn_options(degrees_of_freedom);
  DrawnVehicle vehicle(simulation::in_bends, drawn_radars(1), options, 3);
  SelfCheck check(options);
  while (vehicle.time_s() < duration_s) {
    DrawnMotion drawn = vehicle.next();
    drawn.motion.doppler_nis = 1.0;
    alter(vehicle.time_s(), drawn.motion);
    check.add(drawn.motion, {});
  }
  return check;
}

TEST_CASE("self-check: motions with true covariances raise no doubt") {
  const int degrees_of_freedom = GENERATE(2, 3);
  const SelfCheck check = checked(degrees_of_freedom, [](double, EgoMotion&) {});
  CHECK(check.doubts() == 0);
  CHECK(check.next().mean() > 0.2);
  CHECK(check.next().mean() < 1.1);
  CHECK(check.doppler().mean() == Approx(1.0));
  CHECK(check.doppler().count() == check.next().count());
}

TEST_CASE("self-check: each doubt begins and ends with its cause") {
  struct Row {
    const char* name;
    std::function<void(EgoMotion&)> alter;
    std::uint32_t doubts;
  };
  const auto row = GENERATE(
      Row{"positions against Doppler", [](EgoMotion& m) { m.doppler_nis = 4.0; },
          registration_contradicts_doppler},
      Row{"below the limit", [](EgoMotion& m) { m.doppler_nis = 2.9; }, 0},
      Row{"jumps",
          [](EgoMotion& m) { m.motion.x() += m.utime_us / 75'000 % 2 == 0 ? 0.08 : -0.08; },
          motions_contradict_each_other},
      Row{"covariance far too large",
          [](EgoMotion& m) {
            m.doppler_nis = 0.3;
            m.covariance *= 25.0;
          },
          covariance_too_large},
      Row{"Doppler alone is small", [](EgoMotion& m) { m.doppler_nis = 0.3; }, 0},
      Row{"no Doppler", [](EgoMotion& m) { m.doppler_nis = std::nan(""); }, 0});
  CAPTURE(row.name);
  const SelfCheck during = checked(2, [&](double, EgoMotion& motion) { row.alter(motion); });
  CAPTURE(during.doppler().mean(), during.next().mean());
  CHECK(during.doubts() == row.doubts);
  const SelfCheck past = checked(
      2, [&](double time_s, EgoMotion& motion) { time_s < 20.0 ? row.alter(motion) : void(); },
      90.0);
  CHECK(past.doubts() == 0);
}

TEST_CASE("self-check: only successive estimates of a driving vehicle are compared") {
  const auto count_next = [](const std::function<void(EgoMotion&)>& alter) {
    return checked(2, [&](double, EgoMotion& motion) { alter(motion); }).next().count();
  };
  CHECK(count_next([](EgoMotion&) {}) > 700);
  CHECK(count_next([](EgoMotion& m) { m.status = MotionStatus::standing_still; }) == 0);
  CHECK(count_next([](EgoMotion& m) { m.status = MotionStatus::ambiguous; }) == 0);
  CHECK(count_next([](EgoMotion& m) { m.utime_start_us += 1; }) == 0);
}

TEST_CASE("self-check: motions before and after the clock was set are not compared") {
  const EgoMotionOptions options = drawn_options(2);
  DrawnVehicle vehicle(simulation::in_bends, drawn_radars(1), options, 3);
  SelfCheck check(options);
  while (vehicle.time_s() < 10.0) {
    check.add(vehicle.next().motion, {});
    check.forget();
  }
  CHECK(check.next().count() == 0);
}

}  // namespace
}  // namespace cremed
