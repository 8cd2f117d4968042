// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/traffic.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cremed {
namespace {

constexpr double kOncomingLaneM = 7.0;
constexpr double kSameWayLaneM = 3.5;
constexpr double kSightM = 250.0;  ///< Cars farther along the road are omitted.
constexpr double kLeaderTimeS = 2.0;
constexpr double kLeaderGapM = 9.0;  ///< Distance to the leader at standstill.
constexpr double kJamMomentS =
    0.7;  ///< Cars of a jam drive as we do up to so much later or sooner.

/// Reflectors of a car: its corners, from its centre, forward and left.
constexpr std::array<std::array<double, 2>, 4> kCornersM{
    {{2.1, 0.8}, {2.1, -0.8}, {-2.1, 0.8}, {-2.1, -0.8}}};

}  // namespace

Traffic::Traffic(const VehicleCourse& course, const Road& road, const TrafficOptions& options,
                 Random random)
    : course_(course), road_(road), leader_(options.leader), departures_(options.departures) {
  add_cars(options.oncoming_interval_s, kOncomingLaneM, true, random);
  add_cars(options.same_way_interval_s, kSameWayLaneM, false, random);
  add_jam(options.jam_cars, random);
}

/// On our lane and both lanes to the left, alternately before and behind us.
void Traffic::add_jam(int count, Random& random) {
  for (int i = 0; i < count; ++i) {
    const double left_m = kSameWayLaneM * (i / 2 % 3);
    const int row = 1 + i / 6;  // Three lanes, before and behind.
    const double gap_m = kLeaderGapM * row + random.uniform(0.0, 3.0);
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    jam_.push_back({side * gap_m, random.uniform(-kJamMomentS, kJamMomentS), left_m});
  }
}

void Traffic::add_cars(double mean_interval_s, double left_m, bool oncoming, Random& random) {
  if (mean_interval_s <= 0.0) return;
  for (double time_s = 0.0;;) {
    time_s += mean_interval_s * random.uniform(0.5, 1.5);
    if (time_s > course_.duration_s()) return;
    const VehicleState ours = course_.at(time_s);
    const double speed_mps = oncoming ? -random.uniform(6.0, 14.0)
                                      : std::max(3.0, ours.speed_mps + 4.0 * random.normal());
    cars_.push_back({time_s, ours.distance_m, left_m, speed_mps});
  }
}

void Traffic::reflectors_at(double time_s, std::vector<WorldPoint>& reflectors) const {
  reflectors.clear();
  const double ours_m = course_.at(time_s).distance_m;
  for (const Car& car : cars_) {
    const double distance_m = car.meeting_m + car.speed_mps * (time_s - car.meeting_s);
    if (std::abs(distance_m - ours_m) > kSightM) continue;
    append(distance_m, car.left_m, car.speed_mps, reflectors);
  }
  for (const JamCar& car : jam_) {
    const VehicleState then = course_.at(time_s + car.ahead_s);
    append(then.distance_m + car.ahead_m, car.left_m, then.speed_mps, reflectors);
  }
  for (const Departure& departure : departures_) {
    append(departure, time_s, reflectors);
  }
  if (!leader_) return;
  const VehicleState ahead = course_.at(time_s + kLeaderTimeS);
  append(ahead.distance_m + kLeaderGapM, 0.0, ahead.speed_mps, reflectors);
}

void Traffic::append(double distance_m, double left_m, double speed_mps,
                     std::vector<WorldPoint>& reflectors) const {
  const RoadPoint point = road_.at(distance_m);
  const Pose2 centre = beside(point, left_m);
  const double cos_yaw = std::cos(centre.yaw_rad);
  const double sin_yaw = std::sin(centre.yaw_rad);
  const double yaw_rate_radps = speed_mps * point.curvature_1pm;
  const double lane_speed_mps = speed_mps * (1.0 - point.curvature_1pm * left_m);
  for (const auto& [forward_m, corner_left_m] : kCornersM) {
    const double along_mps = lane_speed_mps - yaw_rate_radps * corner_left_m;
    const double across_mps = yaw_rate_radps * forward_m;
    reflectors.push_back({centre.x_m + cos_yaw * forward_m - sin_yaw * corner_left_m,
                          centre.y_m + sin_yaw * forward_m + cos_yaw * corner_left_m,
                          cos_yaw * along_mps - sin_yaw * across_mps,
                          sin_yaw * along_mps + cos_yaw * across_mps});
  }
}

void Traffic::append(const Departure& departure, double time_s,
                     std::vector<WorldPoint>& reflectors) {
  const double cos_yaw = std::cos(departure.tail.yaw_rad);
  const double sin_yaw = std::sin(departure.tail.yaw_rad);
  const double driven_s = std::max(0.0, time_s - departure.start_s);
  const double full_s = departure.top_speed_mps / departure.acceleration_mps2;
  const double speed_mps = departure.acceleration_mps2 * std::min(driven_s, full_s);
  const double way_m =
      0.5 * speed_mps * std::min(driven_s, full_s) + speed_mps * std::max(0.0, driven_s - full_s);
  const auto count = static_cast<int>(departure.length_m / departure.spacing_m);
  for (int i = 0; i <= count; ++i) {
    const double along_m = way_m + departure.spacing_m * i;
    for (const double left_m : {-0.5 * departure.width_m, 0.5 * departure.width_m}) {
      reflectors.push_back({departure.tail.x_m + cos_yaw * along_m - sin_yaw * left_m,
                            departure.tail.y_m + sin_yaw * along_m + cos_yaw * left_m,
                            cos_yaw * speed_mps, sin_yaw * speed_mps});
    }
  }
}

}  // namespace cremed
