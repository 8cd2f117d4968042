// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/scenario.hpp"

#include <utility>

namespace cremed {
namespace {

// Legs are {seconds, speed in m/s, curvature in 1/m at their end}. Peak acceleration of a leg is
// 1.875 times its mean; all stay below 3.2 m/s^2 along and 3.6 m/s^2 across.

CoursePlan straight_course() {
  return {14.0, 0.0, {{6.0, 14.0, 0.0}, {8.0, 20.0, 0.0}, {6.0, 20.0, 0.0}, {8.0, 14.0, 0.0}}};
}

CoursePlan bends_course() {
  return {10.0,
          0.0,
          {{2.5, 10.0, 0.03},
           {4.0, 10.0, 0.03},
           {4.0, 10.0, -0.03},
           {4.0, 10.0, -0.03},
           {5.0, 16.0, 0.0},
           {3.0, 16.0, 0.012},
           {4.0, 15.0, 0.012},
           {4.0, 16.0, -0.012},
           {4.0, 15.0, -0.012},
           {7.0, 6.0, 0.0},
           {3.0, 5.0, 0.1},
           {2.0, 5.0, 0.1},
           {4.0, 6.0, -0.08},
           {2.5, 6.0, -0.08},
           {4.0, 10.0, 0.0}}};
}

CoursePlan stop_and_go_course() {
  return {0.0,
          0.0,
          {{3.0, 0.0, 0.0},
           {5.0, 8.0, 0.0},
           {3.0, 8.0, 0.0},
           {5.0, 0.0, 0.005},
           {3.0, 0.0, 0.005},
           {3.0, 2.5, 0.02},
           {2.0, 2.5, 0.02},
           {3.0, 0.0, 0.0},
           {4.0, 0.0, 0.0},
           {7.0, 11.0, -0.01},
           {2.0, 11.0, -0.01},
           {7.0, 0.0, 0.0},
           {2.0, 0.0, 0.0},
           {1.5, 0.8, 0.0},
           {1.5, 0.0, 0.0}}};
}

CoursePlan standing_course() { return {0.0, 0.0, {{10.0, 0.0, 0.0}}}; }

/// A way through a town: lights, turns at crossings, a roundabout, a jam, a road out and back in.
CoursePlan city_course() {
  return {0.0, 0.0, {{4.0, 0.0, 0.0},   // red light
                     {8.0, 13.0, 0.0},  // main street
                     {6.0, 13.5, 0.0},    {4.0, 13.0, 0.008}, {4.0, 13.0, -0.01},
                     {3.0, 13.0, 0.0},    {5.0, 5.5, 0.0},  // turn to the left
                     {2.0, 5.5, 0.1},     {1.5, 5.5, 0.1},    {2.0, 6.0, 0.0},
                     {4.0, 11.0, 0.0},    {4.0, 11.0, 0.0},   {7.0, 0.0, 0.0},  // jam
                     {2.0, 0.0, 0.0},     {3.0, 3.0, 0.0},    {3.0, 0.0, 0.0},
                     {3.0, 0.0, 0.0},     {3.5, 3.5, 0.0},    {2.0, 3.5, 0.0},
                     {3.0, 0.0, 0.0},     {2.0, 0.0, 0.0},    {4.0, 6.0, 0.0},  // turn to the right
                     {2.0, 5.0, -0.12},   {1.5, 5.0, -0.12},  {2.0, 6.0, 0.0},
                     {9.0, 19.0, 0.0},  // road out of town
                     {4.0, 19.0, 0.004},  {4.0, 19.0, 0.008}, {5.0, 19.0, -0.006},
                     {4.0, 19.0, 0.0},    {9.0, 6.0, 0.0},  // roundabout
                     {2.0, 6.0, -0.05},   {2.0, 6.0, 0.07},   {4.0, 6.0, 0.07},
                     {2.0, 6.0, -0.05},   {2.0, 7.0, 0.0},    {4.0, 10.0, 0.0},
                     {4.0, 10.0, -0.004}, {7.0, 0.0, 0.0},  // the next red light
                     {4.0, 0.0, 0.0}}};
}

Scenario drive(std::string_view name, std::string_view description, double duration_s,
               CoursePlan course, const WorldOptions& world = {},
               const TrafficOptions& traffic = {}, const FaultOptions& faults = {}) {
  return {name, description, duration_s, std::move(course), world, traffic, faults};
}

std::vector<Scenario> all_scenarios() {
  const WorldOptions sparse{.built_share = 0.3, .clutter_per_m = 0.1};
  const WorldOptions desert{.built_share = 0.03, .clutter_per_m = 0.01};
  const TrafficOptions crowd{
      .oncoming_interval_s = 1.5, .same_way_interval_s = 2.5, .leader = true};
  const TrafficOptions no_traffic{
      .oncoming_interval_s = 0.0, .same_way_interval_s = 0.0, .leader = false};
  const FaultOptions lossy{.frame_loss = 1e-3, .silence_period_s = 0.0, .silence_s = 0.0};
  const FaultOptions silent{.frame_loss = 0.0, .silence_period_s = 20.0, .silence_s = 2.0};
  return {
      drive("straight", "a straight road, 14 to 20 m/s", 60.0, straight_course()),
      drive("bends", "bends both ways, wide and tight, at 5 to 16 m/s", 60.0, bends_course()),
      drive("stop-and-go", "starts, stops, creeping and standing", 60.0, stop_and_go_course()),
      drive("standing", "never moves; others do", 30.0, standing_course()),
      drive("city", "a drive through a town: all of these", 150.0, city_course()),
      drive("crowd", "stop and go among so many cars that few targets stand still", 60.0,
            stop_and_go_course(), sparse, crowd),
      drive("desert", "bends where there is next to nothing to see", 60.0, bends_course(), desert,
            no_traffic),
      drive("lossy", "the town, but one frame in a thousand is lost", 150.0, city_course(), {}, {},
            lossy),
      drive("silent", "the town, but all radars are silent for 2 s out of 20", 150.0, city_course(),
            {}, {}, silent),
  };
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> kAll = all_scenarios();
  return kAll;
}

const Scenario* find_scenario(std::string_view name) {
  for (const Scenario& scenario : scenarios()) {
    if (scenario.name == name) return &scenario;
  }
  return nullptr;
}

}  // namespace cremed
