// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include <catch2/catch.hpp>

#include "tools/simulate/scenario.hpp"
#include "tools/simulate/scene.hpp"
#include "tools/simulate/slow_error.hpp"

using namespace cremed;

TEST_CASE("A slow error has its deviation, is the same for a moment, and another one later") {
  double square = 0.0;
  double soon = 0.0;
  double late = 0.0;
  double number = 0.0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const SlowError error(0.1, Random(seed, 0));
    for (int i = 0; i < 20; ++i) {
      const double time_s = 3.7 * i;
      square += error.at(time_s) * error.at(time_s);
      soon += error.at(time_s) * error.at(time_s + 0.05);
      late += error.at(time_s) * error.at(time_s + 5.0);
      number += 1.0;
    }
  }
  CHECK(std::sqrt(square / number) == Approx(0.1).epsilon(0.03));
  CHECK(soon / square > 0.9);
  CHECK(std::abs(late / square) < 0.1);
}

TEST_CASE("The body moves over the rear axle while driving, and rests with it") {
  const Scenario* scenario = find_scenario("stop-and-go");
  REQUIRE(scenario != nullptr);
  const Scene scene(*scenario, 40.0, 0, 1, 0.1);
  int standing = 0;
  double square = 0.0;
  double number = 0.0;
  for (double time_s = 0.0; time_s < 40.0; time_s += 0.05) {
    const double speed_mps = scene.course().at(time_s).speed_mps;
    const double over_mps = scene.body(time_s).speed_mps - speed_mps;
    if (speed_mps == 0.0) {
      ++standing;
      CHECK(over_mps == 0.0);
    } else if (speed_mps > 1.0) {
      square += over_mps * over_mps;
      number += 1.0;
    }
  }
  CHECK(standing > 20);
  CHECK(std::sqrt(square / number) == Approx(0.1).epsilon(0.4));  // One seed, 40 s.
}
