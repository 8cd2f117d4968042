// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/radar_view.hpp"

#include <cmath>

namespace cremed {

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

}  // namespace cremed
