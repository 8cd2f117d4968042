// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "test/tools/simulated_drive.hpp"
#include "tools/simulate/road.hpp"
#include "tools/simulate/traffic.hpp"
#include "tools/simulate/world.hpp"

namespace {

using cremed::Echo;
using cremed::EchoKind;
using cremed::Motion;
using cremed::test::Drive;

Drive drive_of(const std::string& name, double duration_s, std::uint64_t seed = 1) {
  cremed::SimulationOptions options;
  options.seed = seed;
  options.duration_s = duration_s;
  return cremed::test::drive(cremed::test::scenario(name), cremed::test::one_of_each_kind(),
                             options);
}

constexpr double kStepS = 0.002;  // For velocities from two positions.

}  // namespace

TEST_CASE("an ARS408 tells standing from moving targets by their Doppler over ground") {
  const Drive drive = drive_of("crowd", 60.0);
  const auto scans = cremed::test::decode(drive.log(), drive.radars[0]).scans;
  std::map<std::pair<EchoKind, Motion>, std::size_t> seen;
  std::size_t scan_index = 0;
  std::size_t usable = 0;
  std::size_t fixed = 0;
  for (const auto& truth : drive.truths) {
    if (truth.radar != 0) continue;
    const auto& scan = scans.at(scan_index++);
    for (std::size_t i = 0; i < scan.count; ++i) {
      const Echo& echo = truth.echoes[i];
      const bool moves = std::abs(echo.view.ground_doppler_mps) > 0.5;
      REQUIRE((scan.detections[i].motion == Motion::moving) == moves);
      ++seen[{echo.kind, scan.detections[i].motion}];
      if (echo.kind != EchoKind::fixed) continue;
      ++fixed;
      usable += scan.detections[i].validity == cremed::Validity::usable ? 1U : 0U;
    }
  }
  CHECK(seen[{EchoKind::fixed, Motion::moving}] == 0);
  CHECK(seen[{EchoKind::vehicle, Motion::moving}] > 1000);
  CHECK(seen[{EchoKind::vehicle, Motion::stationary}] > 100);
  CHECK(seen[{EchoKind::ghost, Motion::moving}] > 100);
  CHECK(seen[{EchoKind::ghost, Motion::stationary}] > 100);
  CHECK(static_cast<double>(usable) / static_cast<double>(fixed) == Approx(0.85).margin(0.05));
}

TEST_CASE("in a crowd most targets move, elsewhere most stand") {
  const auto moving_share = [](const std::string& name) {
    double moving = 0.0;
    double all = 0.0;
    for (const auto& truth : drive_of(name, 30.0).truths) {
      for (const Echo& echo : truth.echoes) {
        moving += std::abs(echo.view.ground_doppler_mps) > 0.5 ? 1.0 : 0.0;
        all += 1.0;
      }
    }
    return moving / all;
  };
  CHECK(moving_share("crowd") > 0.5);
  CHECK(moving_share("city") < 0.25);
}

TEST_CASE("standing targets drop in and out; ghosts never come twice") {
  const Drive drive = drive_of("standing", 20.0);
  std::map<std::pair<double, double>, std::size_t> fixed;
  std::map<std::pair<double, double>, std::size_t> ghosts;
  std::size_t scans = 0;
  for (const auto& truth : drive.truths) {
    if (truth.radar != 0) continue;
    ++scans;
    for (const Echo& echo : truth.echoes) {
      if (echo.kind == EchoKind::fixed) ++fixed[{echo.x_m, echo.y_m}];
      if (echo.kind == EchoKind::ghost) ++ghosts[{echo.view.range_m, echo.view.azimuth_rad}];
    }
  }
  const auto steady =
      std::ranges::count_if(fixed, [&](const auto& entry) { return entry.second == scans; });
  const auto frequent =
      std::ranges::count_if(fixed, [&](const auto& entry) { return entry.second > scans / 2; });
  CHECK(steady == 0);
  CHECK(frequent > 30);
  CHECK(ghosts.size() > 2 * scans);
  for (const auto& [place, count] : ghosts) REQUIRE(count == 1);
}

TEST_CASE("targets of one scan are as far apart as the radar can resolve") {
  const Drive drive = drive_of("city", 20.0);
  for (const auto& truth : drive.truths) {
    if (truth.radar != 0) continue;
    for (std::size_t i = 0; i < truth.echoes.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const auto& a = truth.echoes[i].view;
        const auto& b = truth.echoes[k].view;
        const bool same = std::abs(a.range_m - b.range_m) < 0.42 &&
                          std::abs(a.azimuth_rad - b.azimuth_rad) < 0.055 &&
                          std::abs(a.doppler_mps - b.doppler_mps) < 0.12;
        REQUIRE_FALSE(same);
      }
    }
  }
}

TEST_CASE("radars see only what is in their beam") {
  for (const auto& truth : drive_of("city", 20.0).truths) {
    if (truth.radar != 0) continue;
    for (const Echo& echo : truth.echoes) {
      const double azimuth_deg = std::abs(echo.view.azimuth_rad) * 180.0 / M_PI;
      const double reach_m = azimuth_deg < 9.0 ? 200.0 : azimuth_deg < 45.0 ? 90.0 : 20.0;
      REQUIRE(azimuth_deg <= 60.0);
      REQUIRE(echo.view.range_m <= reach_m + 1e-6);
      REQUIRE(echo.view.range_m >= 1.0);
    }
  }
}

TEST_CASE("nothing stands on the road, even where it crosses itself") {
  const cremed::CoursePlan loop{8.0, {{60.0, 8.0, 0.05}}, 0.05};
  const cremed::VehicleCourse course(loop, 60.0);
  const cremed::Road road(course);
  const cremed::World world(road, {}, cremed::Random(1, 1));
  REQUIRE(world.reflectors().size() > 200);
  double nearest_m = 1e9;
  for (const auto& state : course.steps()) {
    for (const auto& reflector : world.reflectors()) {
      nearest_m = std::min(
          nearest_m, std::hypot(reflector.x_m - state.pose.x_m, reflector.y_m - state.pose.y_m));
    }
  }
  CHECK(nearest_m > 2.9);
}

TEST_CASE("other cars move as their velocities say, and the leader keeps its distance") {
  const auto& bends = cremed::test::scenario("bends");
  const cremed::VehicleCourse course(bends.course, 65.0);
  const cremed::Road road(course);
  const cremed::Traffic traffic(course, road, bends.traffic, cremed::Random(1, 2));
  std::vector<cremed::WorldPoint> now;
  std::vector<cremed::WorldPoint> later;
  double worst_mps = 0.0;
  double sum_mps = 0.0;
  std::size_t count = 0;
  for (int moment = 0; moment < 160; ++moment) {
    const double time_s = 0.37 * moment;
    traffic.reflectors_at(time_s, now);
    traffic.reflectors_at(time_s + kStepS, later);
    REQUIRE(now.size() >= 4);
    if (now.size() != later.size()) continue;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double error_mps = std::hypot((later[i].x_m - now[i].x_m) / kStepS - now[i].x_mps,
                                          (later[i].y_m - now[i].y_m) / kStepS - now[i].y_mps);
      worst_mps = std::max(worst_mps, error_mps);
      sum_mps += error_mps;
      ++count;
    }
    const auto& leader = now.back();
    const cremed::Pose2 ours = course.at(time_s).pose;
    REQUIRE(std::hypot(leader.x_m - ours.x_m, leader.y_m - ours.y_m) > 5.0);
  }
  CHECK(sum_mps / static_cast<double>(count) < 0.1);
  CHECK(worst_mps < 2.0);
}

TEST_CASE("what departs stands until its start and then accelerates to its top speed") {
  const cremed::VehicleCourse course(cremed::test::scenario("standing").course, 60.0);
  const cremed::Road road(course);
  cremed::TrafficOptions options{
      .oncoming_interval_s = 0.0, .same_way_interval_s = 0.0, .leader = false};
  options.departures = {{{-5.0, 4.0, 0.0}, 10.0, 2.0, 5.0, 6.0, 0.5, 4.0}};
  const cremed::Traffic traffic(course, road, options, cremed::Random(1, 2));
  std::vector<cremed::WorldPoint> reflectors;
  const auto first_at = [&](double time_s) {
    traffic.reflectors_at(time_s, reflectors);
    REQUIRE(reflectors.size() == 6);  // Three on each side.
    return reflectors.front();
  };
  CHECK(first_at(5.9).x_m == -5.0);
  CHECK(first_at(5.9).y_m == 3.0);
  CHECK(first_at(5.9).x_mps == 0.0);
  CHECK(first_at(10.0).x_m == Approx(-5.0 + 4.0));
  CHECK(first_at(10.0).x_mps == Approx(2.0));
  CHECK(first_at(16.0).x_m == Approx(-5.0 + 16.0 + 8.0));
  CHECK(first_at(16.0).x_mps == Approx(4.0));
}
