// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/scenario.hpp"

namespace cremed {
namespace {

// Legs are {seconds, speed in m/s, curvature in 1/m at their end}. Peak acceleration of a leg is
// 1.875 times its mean; all stay below 3.2 m/s^2 along and 3.6 m/s^2 across.

CoursePlan straight_course() {
  return {14.0, {{6.0, 14.0, 0.0}, {8.0, 20.0, 0.0}, {6.0, 20.0, 0.0}, {8.0, 14.0, 0.0}}};
}

CoursePlan bends_course() {
  return {10.0,
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

CoursePlan standing_course() { return {0.0, {{10.0, 0.0, 0.0}}}; }

/// A drive through a town: traffic lights, turns, a roundabout, a jam, a road out and back in.
CoursePlan city_course() {
  return {0.0, {{4.0, 0.0, 0.0},   // red light
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

/// Out of a parking place, backwards round corners in both directions, and forwards again.
CoursePlan reversing_course() {
  return {0.0,
          {{1.0, 0.0, 0.0},
           {3.0, -3.0, 0.0},
           {2.0, -3.0, 0.1},
           {3.0, -3.0, 0.1},
           {3.0, -5.0, -0.05},
           {3.0, -5.0, -0.05},
           {4.0, 0.0, 0.0},
           {3.0, 3.0, 0.05},
           {2.0, 3.0, -0.05},
           {3.0, 0.0, 0.0}}};
}

/// Near the tyres' limit: 8.7 m/s^2 at the peak.
CoursePlan braking_course() {
  return {20.0,
          {{1.0, 20.0, 0.0},
           {4.3, 0.0, 0.0},
           {1.0, 0.0, 0.0},
           {8.0, 12.0, 0.0},
           {1.0, 12.0, 0.01},
           {2.6, 0.0, 0.01},
           {1.0, 0.0, 0.0},
           {12.1, 20.0, 0.0}}};
}

/// Oversteers in bends in both directions, up to 14 degrees, and recovers.
CoursePlan skid_course() {
  return {10.0,
          {{2.0, 11.0, 0.02, 0.0},
           {1.0, 11.0, 0.05, -2.5},
           {1.0, 10.0, 0.05, -2.5},
           {1.0, 10.0, 0.0, 0.5},
           {1.0, 10.0, 0.0, 0.0},
           {2.0, 11.0, -0.02, 0.0},
           {1.0, 11.0, -0.05, 2.5},
           {1.0, 10.0, -0.04, 2.0},
           {1.5, 10.0, 0.0, 0.0}}};
}

CoursePlan tunnel_course() {
  return {15.0,
          {{6.0, 20.0, 0.0},
           {4.0, 20.0, 0.004},
           {4.0, 18.0, 0.004},
           {5.0, 15.0, -0.004},
           {5.0, 15.0, 0.0}}};
}

CoursePlan jam_course() {
  return {0.0,
          {{3.0, 0.0, 0.0},
           {4.0, 4.0, 0.0},
           {3.0, 5.0, 0.0},
           {3.0, 1.0, 0.004},
           {2.0, 1.0, 0.004},
           {4.0, 6.0, -0.004},
           {4.0, 5.0, 0.0},
           {4.0, 0.0, 0.0}}};
}

/// A full circle at 0.27 to 0.35 rad/s for 20 s.
CoursePlan roundabout_course() {
  return {10.0,
          {{3.0, 6.0, 0.0},
           {2.0, 6.0, -0.05},
           {2.5, 6.0, 0.048},
           {6.0, 5.5, 0.05},
           {6.0, 6.5, 0.054},
           {6.0, 5.5, 0.05},
           {2.5, 6.0, -0.05},
           {2.0, 7.0, 0.0},
           {4.0, 10.0, 0.0}}};
}

/// Up a spiral ramp at 0.4 to 0.5 rad/s and down another one, into a parking place and out of it.
CoursePlan garage_course() {
  return {0.0,
          {{1.0, 0.0, 0.0},
           {3.0, 2.5, 0.0},
           {2.0, 2.5, 0.16},
           {10.0, 2.5, 0.16},
           {2.0, 3.0, 0.165},
           {8.0, 3.0, 0.165},
           {2.0, 2.5, 0.0},
           {3.0, 3.0, 0.0},
           {2.0, 2.5, -0.15},
           {16.0, 2.5, -0.15},
           {2.0, 2.5, 0.0},
           {2.0, 1.5, 0.17},
           {3.0, 0.0, 0.17},
           {2.0, 0.0, 0.0}}};
}

/// U-turns in both directions, each at 0.5 rad/s.
CoursePlan u_turn_course() {
  return {8.0,
          {{4.0, 3.0, 0.0},
           {2.0, 3.0, 0.167},
           {4.3, 3.0, 0.167},
           {2.0, 3.5, 0.0},
           {3.0, 6.0, 0.0},
           {3.0, 3.0, 0.0},
           {2.0, 3.0, -0.167},
           {4.3, 3.0, -0.167},
           {2.0, 3.5, 0.0},
           {3.4, 8.0, 0.0}}};
}

/// Creeps below 1.2 m/s for 12 s, then pulls away.
CoursePlan slow_start_course() {
  return {0.0,
          {{2.0, 0.0, 0.0},
           {2.0, 0.5, 0.0},
           {4.0, 0.5, 0.05},
           {3.0, 1.1, 0.0},
           {3.0, 1.1, -0.03},
           {6.0, 11.0, 0.0},
           {5.0, 11.0, 0.004},
           {7.0, 0.0, 0.0}}};
}

/// Walking speed on footpaths, with turns that are too tight for a car.
CoursePlan campus_course() {
  return {0.0,
          {{2.0, 0.0, 0.0},
           {2.0, 1.1, 0.0},
           {12.0, 1.1, 0.0},
           {1.5, 0.7, 0.9},
           {1.5, 0.8, 0.9},
           {1.5, 1.1, 0.0},
           {8.0, 1.2, 0.1},
           {6.0, 1.0, -0.15},
           {1.5, 0.6, -1.2},
           {2.0, 0.6, -1.2},
           {1.5, 1.0, 0.0},
           {9.0, 1.2, 0.0},
           {2.0, 0.0, 0.0},
           {3.0, 0.0, 0.0},
           {2.0, 0.9, 0.0},
           {1.5, 0.6, 1.3},
           {3.0, 0.6, 1.3},
           {1.5, 1.0, -0.1},
           {8.0, 1.1, 0.05}}};
}

std::vector<Scenario> all_scenarios() {
  const WorldOptions town{};
  const WorldOptions sparse{.built_share = 0.3, .clutter_per_m = 0.1};
  const WorldOptions desert{.built_share = 0.03, .clutter_per_m = 0.01};
  const WorldOptions field{.built_share = 0.0, .clutter_per_m = 0.5};
  const WorldOptions campus{.built_share = 0.0, .clutter_per_m = 0.0, .clutter_per_m2 = 0.008};
  const WorldOptions tunnel{.clutter_per_m = 0.0, .roadside = Roadside::tunnel};
  const WorldOptions garage{.clutter_per_m = 0.1, .roadside = Roadside::garage};
  const TrafficOptions usual{};
  const TrafficOptions crowd{
      .oncoming_interval_s = 1.5, .same_way_interval_s = 2.5, .leader = true};
  const TrafficOptions no_traffic{
      .oncoming_interval_s = 0.0, .same_way_interval_s = 0.0, .leader = false};
  const TrafficOptions jam{
      .oncoming_interval_s = 0.0, .same_way_interval_s = 0.0, .leader = false, .jam_cars = 18};
  const FaultOptions lossy{.frame_loss = 1e-3};
  const FaultOptions silent{.silence_period_s = 20.0, .silence_s = 2.0};
  const FaultOptions gaps{.silence_period_s = 1.5, .silence_s = 0.3};
  const FaultOptions blind{.blind_period_s = 2.0, .blind_s = 0.25};
  return {
      {"straight", "a straight road, 14 to 20 m/s", 60.0, straight_course()},
      {"bends", "wide and tight bends in both directions, 5 to 16 m/s", 60.0, bends_course()},
      {"stop-and-go", "starts, stops, creeping and standing", 60.0, stop_and_go_course()},
      {"standing", "standstill among moving cars", 30.0, standing_course()},
      {"city", "a drive through a town: all of these", 150.0, city_course()},
      {"crowd", "stop and go among so many cars that few targets stand still", 60.0,
       stop_and_go_course(), sparse, crowd},
      {"desert", "bends with almost no targets", 60.0, bends_course(), desert, no_traffic},
      {"lossy", "the town, with one frame in a thousand lost", 150.0, city_course(), town, usual,
       lossy},
      {"silent", "the town, with all radars silent for 2 s in 20", 150.0, city_course(), town,
       usual, silent},
      {"gaps", "the town, with all radars silent for 0.3 s in 1.5", 150.0, city_course(), town,
       usual, gaps},
      {"empty", "the town, with no targets for 0.25 s in 2", 150.0, city_course(), town, usual,
       blind},
      {"field", "bends in an open field with few targets", 60.0, bends_course(), field, no_traffic},
      {"tunnel", "smooth walls, at 15 to 20 m/s", 60.0, tunnel_course(), tunnel, no_traffic},
      {"jam", "creeping among cars that drive as we do; few static targets", 60.0, jam_course(),
       sparse, jam},
      {"reversing", "backwards round corners in both directions, and forwards again", 54.0,
       reversing_course(), town, no_traffic},
      {"braking", "from 20 and 12 m/s to a stop with up to 8.7 m/s^2", 62.0, braking_course()},
      {"skid", "oversteer; for degrees_of_freedom = 3", 46.0, skid_course(), town, no_traffic},
      {"roundabout", "a roundabout at 0.27 to 0.35 rad/s for 20 s, repeated", 68.0,
       roundabout_course()},
      {"garage", "spiral ramps of a parking garage at 0.4 to 0.5 rad/s, close walls", 58.0,
       garage_course(), garage, no_traffic},
      {"u-turn", "U-turns in both directions at 0.5 rad/s", 60.0, u_turn_course(), town,
       no_traffic},
      {"slow-start", "creeps below 1.2 m/s for 12 s, then pulls away", 30.0, slow_start_course()},
      {"campus", "a mobile robot at about 1 m/s, tight turns, few targets", 120.0, campus_course(),
       campus, no_traffic},
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
