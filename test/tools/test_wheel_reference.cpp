// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "test/tools/circle.hpp"

using namespace cremed;
using namespace cremed::test;

TEST_CASE("Wheels are integrated along the arc, between their stamps too") {
  const auto circle = GENERATE(Circle{8.0, 0.1}, Circle{8.0, -0.5}, Circle{-3.0, 0.2},
                               Circle{20.0, 1e-9}, Circle{0.0, 0.3});
  CAPTURE(circle.speed_mps, circle.yaw_rate_radps);
  const WheelReference wheels = read_wheels(circle.wheels_csv(10.0));
  struct Row {
    std::int64_t start_us;
    std::int64_t end_us;
  };
  const auto row = GENERATE(Row{0, 75'000}, Row{1'234'567, 1'309'999}, Row{4'000'000, 9'000'000},
                            Row{2'000'000, 2'000'000});
  const auto motion = wheels.motion(row.start_us, row.end_us);
  REQUIRE(motion);
  const Eigen::Vector3d expected =
      circle.motion(static_cast<double>(row.end_us - row.start_us) * 1e-6);
  // Chords of 10 ms: (w dt)^2 / 12 of the way, and as much again between the stamps.
  const double margin_m = 1e-5 * std::abs(circle.speed_mps) + 1e-9;
  CHECK(motion->x() == Approx(expected.x()).margin(margin_m));
  CHECK(motion->y() == Approx(expected.y()).margin(margin_m));
  CHECK(motion->z() == Approx(expected.z()).margin(1e-9));
}

TEST_CASE("Changing speed is integrated by the trapezoid rule, rates are interpolated") {
  const WheelReference wheels = read_wheels(
      "utime,speed_mps,yaw_rate_radps\n0,0,0\n1000000,10,0.4\n3000000,10,0.4\n", {0.02, 0.003});
  CHECK(wheels.motion(0, 1'000'000)->z() == Approx(0.2));
  const auto rates = wheels.rates(250'000);
  REQUIRE(rates);
  CHECK(rates->x() == Approx(2.5));
  CHECK(rates->y() == Approx(0.1));
  CHECK(wheels.rates(3'000'000)->x() == Approx(10.0));
  CHECK(wheels.std().yaw_rate_radps == 0.003);
}

TEST_CASE("What the wheels did in a gap is not known") {
  std::string csv = "utime,speed_mps,yaw_rate_radps\n";
  for (int i = 0; i <= 100; ++i) {
    csv += i > 40 && i < 70 ? "" : std::to_string(100'000 * i) + ",8,0.1\n";
  }
  const WheelReference wheels = read_wheels(csv);
  REQUIRE(wheels.gaps().size() == 1);
  CHECK(wheels.gaps()[0].begin_us == 4'000'000);
  CHECK(wheels.gaps()[0].end_us == 7'000'000);
  CHECK(wheels.motion(3'000'000, 4'000'000));
  CHECK_FALSE(wheels.motion(3'000'000, 4'000'001));
  CHECK_FALSE(wheels.motion(3'000'000, 8'000'000));
  CHECK(wheels.motion(7'000'000, 8'000'000));
  CHECK(wheels.rates(4'000'000));
  CHECK_FALSE(wheels.rates(5'000'000));
}

TEST_CASE("Wheels tell nothing outside of their time, and bad files are refused with the place") {
  const WheelReference wheels = read_wheels(Circle{}.wheels_csv(1.0));
  CHECK_FALSE(wheels.motion(-1, 500'000));
  CHECK_FALSE(wheels.motion(500'000, 1'000'001));
  CHECK_FALSE(wheels.rates(1'000'001));
  CHECK_FALSE(read_wheels("utime,speed_mps,yaw_rate_radps\n").rates(0));
  CHECK_THROWS_WITH(read_wheels("utime,speed_mps\n0,1\n"),
                    Catch::Contains("no column yaw_rate_radps"));
  CHECK_THROWS_WITH(read_wheels("utime,speed_mps,yaw_rate_radps\n5,1,0\n5,1,0\n"),
                    Catch::Contains("row 2: utime does not increase"));
  CHECK_THROWS_WITH(read_wheels("utime,speed_mps,yaw_rate_radps\n5,fast,0\n"),
                    Catch::Contains("'fast' is not a number"));
  CHECK_THROWS_WITH(read_wheels("utime,speed_mps,yaw_rate_radps\n5,nan,0\n"),
                    Catch::Contains("line 2, speed_mps: 'nan' is not finite"));
}
