// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>

#include <catch2/catch.hpp>

#include "tools/laboratory/pairs/pairs_evaluation.hpp"
#include "tools/laboratory/pairs/profile.hpp"
#include "tools/laboratory/pairs/registration_pairs.hpp"

using namespace cremed;

TEST_CASE("Pairs are read with their truth, mount and detections") {
  std::istringstream text(
      "# a comment\n"
      "T,0,0.5,0.25,-0.125,0.075\n"
      "M,0,3.4,-0.5,0.01\n"
      "D,0,0,7,10,0.5,-8,0.2,0.05,0.3\n"
      "D,0,1,7,9.5,0.5,-8.5,0.2,0.05,0.3\n"
      "T,1,1,0,0,0.2\n");
  const auto pairs = read_registration_pairs(text);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].truth.yaw_rad == -0.125);
  CHECK(pairs[0].dt_s == 0.075);
  CHECK(pairs[0].vehicle_from_radar.y_m == -0.5);
  REQUIRE(pairs[0].previous.size() == 1);
  REQUIRE(pairs[0].current.size() == 1);
  CHECK(pairs[0].current[0].range_m == 9.5);
  CHECK(pairs[0].current[0].doppler_mps == -8.5);
  CHECK(pairs[0].current[0].doppler_std_mps == 0.3);
  CHECK(pairs[0].previous[0].id == 7);
  CHECK(pairs[1].vehicle_from_radar.x_m == 0.0);
}

TEST_CASE("A line that is none is refused with its number") {
  const auto read = [](const char* text) {
    std::istringstream input(text);
    return read_registration_pairs(input);
  };
  CHECK_THROWS_WITH(read("T,0,1,2\n"), Catch::Contains("line 1: expected 5 numbers"));
  CHECK_THROWS_WITH(read("D,0,0,7,10,0.5,-8,0.2,0.05,0.3\n"),
                    Catch::Contains("begins with a line T"));
  CHECK_THROWS_WITH(read("T,0,1,2,3,x\n"), Catch::Contains("line 1: not a number"));
  CHECK_THROWS_WITH(read("T,0,1,2,3,4\nQ,1\n"), Catch::Contains("line 2"));
}

TEST_CASE("The profiles are the paper's settings") {
  const auto psr = profile("psr", false);
  CHECK(psr->degrees_of_freedom == 3);
  CHECK(psr->outlier_ray.weight == 0.0);
  CHECK(psr->start_scale == 1.0);
  CHECK_FALSE(psr->doppler.enabled);
  const auto sim = profile("sim", true);
  CHECK(sim->degrees_of_freedom == 2);
  CHECK(sim->outlier_ray.weight == 0.2);
  CHECK(sim->start_scale == 6.0);
  CHECK(sim->start_doppler_scale == 1.0);
  CHECK(sim->doppler.stamp_std_s == 0.0);
  CHECK(sim->doppler.enabled);
  const auto nuscenes = profile("nuscenes", true);
  CHECK(nuscenes->outlier_ray.weight == 0.5);
  CHECK(nuscenes->start_scale == 5.0);
  CHECK(nuscenes->start_doppler_scale == 2.0);
  CHECK(nuscenes->doppler.stamp_std_s == 0.005);
  CHECK_FALSE(profile("robo", true));
}

TEST_CASE("A pair without targets is left out of the figures, not counted as good") {
  std::istringstream text("T,0,0.5,0,0,0.1\n");
  const auto pairs = read_registration_pairs(text);
  const auto results = solve_pairs(pairs, *profile("sim", true));
  const PairsFigures figures = pairs_figures(results, 2);
  CHECK(figures.credibility.count() == 0);
  CHECK(figures.left_out == 1);
  CHECK_FALSE(results[0].registration.motion.allFinite());
}
