// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/configuration_sections.hpp"

namespace cremed {
namespace {

constexpr Range kAngleRad{0.0, 1.0};
constexpr Range kVelocityMps{0.0, 10.0};

void read_vehicle(TomlReader& reader, OdometryOptions& options) {
  reader.number("acceleration_std_mps2", options.acceleration.std, {0.01, 100.0});
  reader.number("yaw_acceleration_std_radps2", options.yaw_acceleration.std, {0.001, 100.0});
  reader.number("slip_std_rad", options.slip_std_rad, kAngleRad);
  reader.number("body_velocity_std_mps", options.body_velocity.std, kVelocityMps);
}

void read_radar_errors(TomlReader& reader, OdometryOptions& options) {
  reader.number("mount_yaw_std_rad", options.mount_yaw_std_rad, kAngleRad);
  reader.number("mount_position_std_m", options.lever_std_m, {0.0, 10.0});
  reader.number("doppler_scale_std", options.doppler_scale_std, {0.0, 1.0});
  reader.number("doppler_offset_std_mps", options.offset.std, kVelocityMps);
  reader.number("azimuth_scale_std", options.azimuth_scale_std, {0.0, 1.0});
}

void read_limits(TomlReader& reader, OdometryOptions& options) {
  reader.integer("min_targets", options.min_targets, 2, 256);
  reader.number("predicted_s", options.predicted_s, {0.01, 10.0});
  reader.number("lost_s", options.lost_s, {0.01, 60.0});
  reader.number("anchor_period_s", options.anchor_period_s, {0.1, 60.0});
  reader.number("max_lateness_s", options.max_lateness_s, {0.0, 1.0});
  reader.number("max_gap_s", options.max_gap_s, {0.1, 60.0});
  reader.integer("rate_hz", options.rate_hz, 0, 200);
  reader.require_less("predicted_s", options.predicted_s, "lost_s", options.lost_s);
}

}  // namespace

void read_slip_per_lateral_acceleration(TomlReader& reader, OdometryConfiguration& odometry) {
  reader.number("slip_per_lateral_acceleration", odometry.filter.slip_per_lateral_acceleration,
                {-0.05, 0.05});
}

void read_odometry(TomlReader reader, OdometryConfiguration& odometry) {
  reader.boolean("enabled", odometry.enabled);
  reader.text("state_file", odometry.state_file,
              {[](std::string_view) { return true; }, "a path, or \"\" for none"});
  read_slip_per_lateral_acceleration(reader, odometry);
  read_vehicle(reader, odometry.filter);
  read_radar_errors(reader, odometry.filter);
  read_limits(reader, odometry.filter);
  reader.finish();
}

}  // namespace cremed
