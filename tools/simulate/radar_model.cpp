// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/radar_model.hpp"

#include <algorithm>
#include <cmath>

namespace cremed {
namespace {

constexpr double kRcsFluctuationDb = 2.0;
constexpr double kVehicleProbability = 0.85;
constexpr double kVehicleRcsDbm2 = 10.0;
constexpr double kGhostSpeedMps = 15.0;

}  // namespace

RadarState radar_state(const VehicleState& vehicle, const Pose2& vehicle_from_radar) {
  const double cos_yaw = std::cos(vehicle.pose.yaw_rad);
  const double sin_yaw = std::sin(vehicle.pose.yaw_rad);
  const Pose2& mount = vehicle_from_radar;
  const double arm_x_m = cos_yaw * mount.x_m - sin_yaw * mount.y_m;
  const double arm_y_m = sin_yaw * mount.x_m + cos_yaw * mount.y_m;
  return {{vehicle.pose.x_m + arm_x_m, vehicle.pose.y_m + arm_y_m,
           vehicle.pose.yaw_rad + mount.yaw_rad},
          vehicle.speed_mps * cos_yaw - vehicle.side_speed_mps * sin_yaw -
              vehicle.yaw_rate_radps * arm_y_m,
          vehicle.speed_mps * sin_yaw + vehicle.side_speed_mps * cos_yaw +
              vehicle.yaw_rate_radps * arm_x_m};
}

RadarView view_of(const RadarState& radar, const WorldPoint& point) {
  const double cos_yaw = std::cos(radar.pose.yaw_rad);
  const double sin_yaw = std::sin(radar.pose.yaw_rad);
  const double world_x_m = point.x_m - radar.pose.x_m;
  const double world_y_m = point.y_m - radar.pose.y_m;
  const double world_x_mps = point.x_mps - radar.x_mps;
  const double world_y_mps = point.y_mps - radar.y_mps;
  RadarView view;
  view.range_m = std::hypot(world_x_m, world_y_m);
  view.azimuth_rad = std::atan2(cos_yaw * world_y_m - sin_yaw * world_x_m,
                                cos_yaw * world_x_m + sin_yaw * world_y_m);
  view.doppler_mps = (world_x_m * world_x_mps + world_y_m * world_y_mps) / view.range_m;
  view.across_mps = (world_x_m * world_y_mps - world_y_m * world_x_mps) / view.range_m;
  view.ground_doppler_mps = (world_x_m * point.x_mps + world_y_m * point.y_mps) / view.range_m;
  return view;
}

RadarModel::RadarModel(const RadarCharacter& character, const Pose2& vehicle_from_radar,
                       const Scene& scene, Random random)
    : character_(character),
      vehicle_from_radar_(vehicle_from_radar),
      scene_(scene),
      random_(random) {}

const std::vector<Echo>& RadarModel::observe(std::int64_t stamp_us) {
  const double time_s = scene_.seconds(stamp_us);
  radar_ = radar_state(scene_.body(time_s), vehicle_from_radar_);
  echoes_.clear();
  detect_fixed();
  detect_vehicles(time_s);
  add_ghosts();
  merge_unresolved();
  return echoes_;
}

double RadarModel::greatest_range_m(double azimuth_rad) const {
  for (const BeamZone& zone : character_.zones) {
    if (std::abs(azimuth_rad) <= zone.half_angle_rad) return zone.range_m;
  }
  return 0.0;
}

void RadarModel::detect(EchoKind kind, const WorldPoint& point, double rcs_dbm2,
                        double probability) {
  const RadarView view = view_of(radar_, point);
  const double greatest_m = greatest_range_m(view.azimuth_rad);
  if (view.range_m < character_.least_range_m || view.range_m > greatest_m) return;
  const double share = view.range_m / greatest_m;
  if (!random_.chance(probability * (1.0 - 0.5 * share * share))) return;
  echoes_.push_back(
      {kind, view, rcs_dbm2 + kRcsFluctuationDb * random_.normal(), point.x_m, point.y_m});
}

void RadarModel::detect_fixed() {
  const World& world = scene_.world();
  const Pose2& pose = radar_.pose;
  world.grid().visit_near(pose.x_m, pose.y_m, character_.zones.front().range_m,
                          [&](std::size_t index) {
                            const Reflector& reflector = world.reflectors()[index];
                            detect(EchoKind::fixed, {reflector.x_m, reflector.y_m, 0.0, 0.0},
                                   reflector.rcs_dbm2, reflector.detection_probability);
                          });
}

void RadarModel::detect_vehicles(double time_s) {
  scene_.traffic().reflectors_at(time_s, moving_);
  for (const WorldPoint& reflector : moving_) {
    detect(EchoKind::vehicle, reflector, kVehicleRcsDbm2, kVehicleProbability);
  }
}

/// Half of the ghosts are static (multipath of static objects), half move; each is seen once.
void RadarModel::add_ghosts() {
  const double widest_rad = character_.zones.back().half_angle_rad;
  for (std::size_t i = 0; i < 2 * character_.mean_ghosts; ++i) {
    if (!random_.chance(0.5)) continue;
    const double azimuth_rad = random_.uniform(-widest_rad, widest_rad);
    const double range_m = random_.uniform(character_.least_range_m, greatest_range_m(azimuth_rad));
    const double bearing_rad = radar_.pose.yaw_rad + azimuth_rad;
    const double speed_mps =
        random_.chance(0.5) ? random_.uniform(-kGhostSpeedMps, kGhostSpeedMps) : 0.0;
    const WorldPoint point{radar_.pose.x_m + range_m * std::cos(bearing_rad),
                           radar_.pose.y_m + range_m * std::sin(bearing_rad),
                           speed_mps * std::cos(bearing_rad), speed_mps * std::sin(bearing_rad)};
    echoes_.push_back(
        {EchoKind::ghost, view_of(radar_, point), random_.uniform(-15.0, 0.0), 0.0, 0.0});
  }
}

bool RadarModel::same_cell(const RadarView& a, const RadarView& b) const {
  return std::abs(a.range_m - b.range_m) < character_.range_resolution_m &&
         std::abs(a.azimuth_rad - b.azimuth_rad) < character_.azimuth_resolution_rad &&
         std::abs(a.doppler_mps - b.doppler_mps) < character_.doppler_resolution_mps;
}

/// The stronger of two unresolved targets hides the weaker, so every detection has one true place.
void RadarModel::merge_unresolved() {
  std::ranges::stable_sort(echoes_, std::ranges::greater{}, &Echo::rcs_dbm2);
  std::size_t kept = 0;
  for (const Echo& echo : echoes_) {
    const auto hides = [&](const Echo& other) { return same_cell(other.view, echo.view); };
    const auto end = echoes_.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::none_of(echoes_.begin(), end, hides)) echoes_[kept++] = echo;
  }
  echoes_.resize(kept);
}

}  // namespace cremed
