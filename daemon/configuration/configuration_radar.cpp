// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/configuration_radar.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/configuration/bus_options.hpp"
#include "daemon/configuration/configuration_estimator.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/plain_text.hpp"

namespace cremed {
namespace {

constexpr std::array<std::string_view, 2> kTypes = {"ars408", "bosch_gpr"};
constexpr std::array<std::string_view, 2> kOutputs = {"clusters", "objects"};
constexpr std::array<std::string_view, 3> kCrcPolicies = {"off", "count", "enforce"};
constexpr std::size_t kMaxName = 15;
constexpr double kMaxMountM = 50.0;
constexpr double kFullCircleRad = 6.2832;
constexpr double kHalfCircleRad = 3.1416;
constexpr std::uint32_t kMaxStandardId = 0x7FF;

bool is_name(std::string_view text) {
  const auto fits = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-';
  };
  return !text.empty() && text.size() <= kMaxName && text != kFusedSource &&
         text != kOdometrySource && std::all_of(text.begin(), text.end(), fits);
}

bool is_interface(std::string_view text) {
  return !text.empty() && text.size() <= kMaxInterfaceName && text != "." && text != ".." &&
         text.find_first_of(" /:\n\t") == std::string_view::npos && plain_text(text) == text;
}

constexpr std::string_view kRotationLead = "rotation_lead_s";

constexpr TextRule kName = {
    is_name,
    "1 to 15 letters, digits, '_' or '-' (for the LCM channel), and neither \"fused\" nor "
    "\"odometry\""};
constexpr TextRule kInterface = {is_interface,
                                 "1 to 15 characters that print, without space, '/' or ':'"};

void read_ars408(TomlReader& reader, RadarConfiguration& radar) {
  auto& options = radar.decoder.emplace<Ars408Options>();
  reader.integer("sensor_id", options.sensor_id, 0, 7);
  if (const auto output = reader.choice("output", kOutputs)) {
    options.output = static_cast<Ars408Output>(*output);
  }
  reader.bits("keep_invalid_states", options.keep_invalid_states, 31);
  std::uint32_t keep_dyn_props = options.keep_dyn_props;
  reader.bits("keep_dyn_props", keep_dyn_props, 7);
  options.keep_dyn_props = static_cast<std::uint8_t>(keep_dyn_props);
  reader.integer("min_existence_code", options.min_existence_code, 0, 7);
  reader.boolean("motion_feedback", radar.motion_feedback);
}

void check_gpr_ids(TomlReader& reader, const BoschGprOptions& options) {
  if (reader.clean() && options.info_id >= options.base_id &&
      options.info_id < options.base_id + kGprTargetIds) {
    reader.report(
        reader.has("info_id") ? "info_id" : "base_id",
        "makes info_id one of the targets' identifiers; must be outside base_id to base_id + 95");
  }
}

void read_gpr(TomlReader& reader, RadarConfiguration& radar) {
  auto& options = radar.decoder.emplace<BoschGprOptions>();
  reader.identifier("base_id", options.base_id, kMaxStandardId + 1 - kGprTargetIds);
  reader.identifier("info_id", options.info_id, kMaxStandardId);
  if (const auto policy = reader.choice("crc_policy", kCrcPolicies)) {
    options.crc_policy = static_cast<CrcPolicy>(*policy);
  }
  reader.boolean("invert_azimuth", options.invert_azimuth);
  reader.boolean("invert_doppler", options.invert_doppler);
  reader.number("min_existence", options.min_existence, {0.0, 0.96875});
  check_gpr_ids(reader, options);
}

/// The keys that `read` asks for.
std::vector<std::string_view> keys_of(void (*read)(TomlReader&, RadarConfiguration&)) {
  ReadContext scratch{Diagnostics(""), nullptr};
  TomlReader reader(nullptr, "", 0, scratch);
  RadarConfiguration radar;
  read(reader, radar);
  return reader.known();
}

/// Keys of the type that the radar has; those of the other type are refused by name.
void read_decoder(TomlReader& reader, RadarConfiguration& radar) {
  const auto type = reader.choice("type", kTypes, Presence::required);
  if (!type || *type == 0) {
    read_ars408(reader, radar);
  }
  if (!type || *type == 1) {
    read_gpr(reader, radar);
  }
  reader.refuse(keys_of(read_ars408), "is a key of type \"ars408\"; must be left out here");
  reader.refuse(keys_of(read_gpr), "is a key of type \"bosch_gpr\"; must be left out here");
}

void read_mount(TomlReader& reader, Pose2& vehicle_from_radar, Presence presence) {
  reader.number("x_m", vehicle_from_radar.x_m, {-kMaxMountM, kMaxMountM}, presence);
  reader.number("y_m", vehicle_from_radar.y_m, {-kMaxMountM, kMaxMountM}, presence);
  reader.number("yaw_rad", vehicle_from_radar.yaw_rad, {-kFullCircleRad, kFullCircleRad}, presence);
}

void read_limits(TomlReader reader, DetectionLimits& limits) {
  reader.number("min_range_m", limits.min_range_m, {0.0, 2000.0});
  reader.number("max_range_m", limits.max_range_m, {0.0, 2000.0});
  reader.number("max_abs_azimuth_rad", limits.max_abs_azimuth_rad, {0.01, kHalfCircleRad});
  reader.number("min_rcs_dbm2", limits.min_rcs_dbm2, {-100.0, 100.0});
  reader.require_less("min_range_m", limits.min_range_m, "max_range_m", limits.max_range_m);
  reader.finish();
}

/// That of the type.
double default_rotation_lead_s(const RadarConfiguration& radar) {
  const auto* ars408 = std::get_if<Ars408Options>(&radar.decoder);
  return ars408 != nullptr && ars408->output == Ars408Output::clusters ? kArs408RotationLeadS : 0.0;
}

/// Of a sensor that is told the yaw rate.
void read_rotation_lead(TomlReader& reader, RadarConfiguration& radar) {
  if (!std::holds_alternative<Ars408Options>(radar.decoder)) {
    reader.refuse(std::array{kRotationLead},
                  "is a key of type \"ars408\", which is told the yaw rate; must be left out here");
    return;
  }
  reader.number(kRotationLead, radar.ego_motion.correction.rotation_lead_s, {-0.2, 0.2});
}

void read_calibration(TomlReader& reader, RadarConfiguration& radar) {
  DetectionCorrection& correction = radar.ego_motion.correction;
  read_rotation_lead(reader, radar);
  reader.number("stamp_offset_s", radar.stamp_offset_s, {-0.5, 0.5});
  reader.number("doppler_offset_mps", correction.doppler_offset_mps, {-5.0, 5.0});
  reader.number("doppler_scale", correction.doppler_scale, {0.5, 2.0});
  reader.number("range_std_factor", correction.range_std_factor, {0.1, 10.0});
  reader.number("azimuth_std_factor", correction.azimuth_std_factor, {0.1, 10.0});
  reader.number("doppler_std_factor", correction.doppler_std_factor, {0.1, 10.0});
}

/// The tables of one radar that calibration is about.
void read_calibrated(TomlReader& reader, RadarConfiguration& radar) {
  TomlReader mount = reader.table("mount");
  read_mount(mount, radar.ego_motion.vehicle_from_radar, Presence::required);
  mount.finish();
  radar.ego_motion.correction.rotation_lead_s = default_rotation_lead_s(radar);
  TomlReader calibration = reader.table("calibration");
  read_calibration(calibration, radar);
  calibration.finish();
}

}  // namespace

PlacedRadar read_radar(TomlReader reader, const EgoMotionOptions& defaults) {
  PlacedRadar placed{{}, reader.line_of("name"), reader.line_of("interface")};
  RadarConfiguration& radar = placed.radar;
  radar.ego_motion = defaults;
  reader.text("name", radar.name, kName, Presence::required);
  reader.text("interface", radar.interface, kInterface, Presence::required);
  reader.number("scan_timeout_s", radar.scan_timeout_s, {0.001, 0.06});
  read_decoder(reader, radar);
  read_calibrated(reader, radar);
  read_limits(reader.table("limits"), radar.ego_motion.limits);
  read_estimator(reader.table("estimator"), radar.ego_motion);
  reader.finish();
  return placed;
}

void read_calibrated(TomlReader reader, std::vector<PlacedRadar>& radars) {
  for (PlacedRadar& placed : radars) {
    RadarConfiguration& radar = placed.radar;
    if (!radar.name.empty()) {
      TomlReader own = reader.table(radar.name);
      read_mount(own, radar.ego_motion.vehicle_from_radar, Presence::optional);
      read_calibration(own, radar);
      own.finish();
    }
  }
  reader.finish();
}

}  // namespace cremed
