// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/configuration_summary.hpp"

#include <cmath>
#include <numbers>

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

/// Slightly more than pi, for rounded values.
constexpr double kLargestYawRad = 3.15;

constexpr const char* kRow = "{:<15} {:<9} {:<15} {:>8} {:>8} {:>8}  {}\n";

/// "0x600, 0x701-0x702"
std::string text_of(const IdSet& ids) {
  std::vector<std::string> runs;
  for (std::size_t first = ids._Find_first(); first < ids.size();) {
    std::size_t end = first;
    while (end < ids.size() && ids[end]) {
      ++end;
    }
    runs.push_back(end == first + 1 ? fmt::format("0x{:X}", first)
                                    : fmt::format("0x{:X}-0x{:X}", first, end - 1));
    first = ids._Find_next(end - 1);
  }
  return joined(runs);
}

std::string row_of(const RadarConfiguration& radar) {
  const Pose2& mount = radar.ego_motion.vehicle_from_radar;
  return fmt::format(kRow, radar.name, radar.decoder.family().type, radar.interface,
                     fmt::format("{:.3f}", mount.x_m), fmt::format("{:.3f}", mount.y_m),
                     fmt::format("{:.2f}", kDegPerRad * mount.yaw_rad),
                     text_of(radar.decoder.sent_ids()));
}

/// "front 1.01, left 1"
std::string azimuth_scales(const std::vector<RadarConfiguration>& radars) {
  return joined(radars, [](const RadarConfiguration& radar) {
    return fmt::format("{} {:g}", radar.name, radar.ego_motion.correction.azimuth_scale);
  });
}

std::string odometry_text(const Configuration& configuration) {
  const OdometryConfiguration& odometry = configuration.odometry;
  if (!odometry.enabled) {
    return "off";
  }
  const std::string when = odometry.filter.rate_hz > 0.0
                               ? fmt::format("{} times a second", odometry.filter.rate_hz)
                               : "at every scan";
  return "from " + joined(configuration.radars, &RadarConfiguration::name) + "; told " + when +
         (is_fused(configuration) ? "; its motion between scans is \"fused\"" : "");
}

std::string vehicle_text(const VehicleConfiguration& vehicle) {
  std::vector<std::string> ids;
  for (const VehicleSignal signal : {VehicleSignal::speed, VehicleSignal::yaw_rate}) {
    if (vehicle.is_used(signal)) {
      ids.push_back(fmt::format("{} (0x{:X})",
                                signal == VehicleSignal::speed ? "speed" : "yaw rate",
                                *vehicle.id(signal)));
    }
  }
  return ids.empty() ? "" : "\nvehicle bus: " + joined(ids) + " on " + vehicle.interface;
}

std::string output_text(const OutputConfiguration& output) {
  const std::string& nav_msgs = output.nav_msgs_odometry;
  std::vector<std::string> outputs{output.csv, output.odometry, output.tum};
  if (output.lcm_url != "none") {
    outputs.insert(outputs.begin(),
                   concat({"LCM ", output.lcm_url, nav_msgs.empty() ? "" : " with ", nav_msgs}));
  }
  std::erase(outputs, "");
  return outputs.empty() ? "none" : joined(outputs);
}

std::string sent_text(const Configuration& configuration) {
  const std::string names =
      joined_if(configuration.radars, has_motion_feedback, &RadarConfiguration::name);
  return names.empty() ? "nothing" : "speed and yaw rate to " + names + " (motion_feedback)";
}

std::string radar_summary(const RadarConfiguration& radar) {
  const Pose2& mount = radar.ego_motion.vehicle_from_radar;
  return fmt::format("{}: {} on {}, mount x {:.3f} m, y {:.3f} m, yaw {:.2f} deg", radar.name,
                     radar.decoder.label(), radar.interface, mount.x_m, mount.y_m,
                     kDegPerRad * mount.yaw_rad);
}

}  // namespace

std::string configuration_summary(const Configuration& configuration) {
  std::string text =
      fmt::format(kRow, "radar", "type", "interface", "x m", "y m", "yaw deg", "identifiers");
  for (const RadarConfiguration& radar : configuration.radars) {
    text += row_of(radar);
  }
  return text + "azimuth scale: " + azimuth_scales(configuration.radars) +
         "\nodometry: " + odometry_text(configuration) + vehicle_text(configuration.vehicle) +
         "\noutput: " + output_text(configuration.output) +
         "\nsends on the buses: " + sent_text(configuration) + "\n";
}

std::vector<std::string> configuration_doubts(const Configuration& configuration) {
  std::vector<std::string> doubts;
  for (const RadarConfiguration& radar : configuration.radars) {
    // A larger angle is probably in degrees.
    const double yaw = radar.ego_motion.vehicle_from_radar.yaw_rad;
    if (std::abs(yaw) > kLargestYawRad) {
      doubts.push_back(fmt::format(
          "{}: yaw_rad = {:g} is {:.1f} degrees; write {:.4f} if that is meant, and {:.4f} if "
          "{:g} degrees are",
          radar.name, yaw, kDegPerRad * yaw, std::remainder(yaw, 2.0 * std::numbers::pi),
          yaw / kDegPerRad, yaw));
    }
    if (has_motion_feedback(radar) &&
        radar.decoder.as<Ars408Options>()->keep_dyn_props != kEveryDynProp) {
      doubts.push_back(concat({radar.name,
                               ": motion_feedback = true, but keep_dyn_props selects targets by a "
                               "flag that follows from it: an error would confirm itself; set "
                               "keep_dyn_props = [0, 1, 2, 3, 4, 5, 6, 7]"}));
    }
  }
  return doubts;
}

void log_configuration(const std::string& path, const Configuration& configuration) {
  spdlog::info("configuration: {}", path);
  for (const RadarConfiguration& radar : configuration.radars) {
    spdlog::info("{}", radar_summary(radar));
  }
  for (const std::string& doubt : configuration_doubts(configuration)) {
    spdlog::warn("{}", doubt);
  }
}

}  // namespace cremed
