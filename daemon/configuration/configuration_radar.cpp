// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/configuration_radar.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "daemon/configuration/bus_options.hpp"
#include "daemon/configuration/configuration_sections.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/plain_text.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMaxName = 15;
constexpr double kMaxMountM = 50.0;
constexpr double kFullCircleRad = 6.2832;
constexpr double kHalfCircleRad = 3.1416;

bool is_name(std::string_view text) {
  const auto fits = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' ||
           c == '-';
  };
  return !text.empty() && text.size() <= kMaxName && !share_channel(text, kFusedSource) &&
         !share_channel(text, kOdometrySource) && std::ranges::all_of(text, fits);
}

constexpr std::string_view kRotationLead = "rotation_lead_s";

constexpr TextRule kName = {
    is_name,
    "1 to 15 letters, digits, '_' or '-' (for the LCM channel), and neither \"fused\" nor "
    "\"odometry\""};
constexpr TextRule kInterface = {is_interface_name,
                                 "1 to 15 characters that print, without space, '/' or ':'"};

/// In the order of the families.
std::vector<const RadarFamily*> by_type(RadarFamilies families) {
  std::vector<const RadarFamily*> sorted(families.begin(), families.end());
  std::ranges::sort(sorted, {}, &RadarFamily::type);
  return sorted;
}

/// The keys that the family reads.
std::vector<std::string_view> keys_of(const RadarFamily& family) {
  Diagnostics scratch("");
  TomlReader reader(nullptr, "", 0, scratch);
  family.read(reader);
  return reader.known();
}

const RadarFamily* read_type(TomlReader& reader, const std::vector<const RadarFamily*>& families) {
  std::vector<std::string_view> types;
  types.reserve(families.size());
  for (const RadarFamily* family : families) {
    types.push_back(family->type);
  }
  const auto type = reader.choice("type", types, Presence::required);
  return type ? families[*type] : nullptr;
}

/// "ars404" or "ars408": the types that are listed.
template <typename Listed>
std::string types_text(const std::vector<const RadarFamily*>& families, const Listed& is_listed) {
  std::vector<std::string_view> types;
  for (const RadarFamily* family : families) {
    if (is_listed(*family)) {
      types.push_back(family->type);
    }
  }
  return list_text(types);
}

/// Keys of the radar's type, or of all types if that is unknown. Keys of other types are reported
/// by name.
void read_decoder(TomlReader& reader, RadarFamilies families, RadarConfiguration& radar) {
  const std::vector<const RadarFamily*> sorted = by_type(families);
  const RadarFamily* const type = read_type(reader, sorted);
  for (const RadarFamily* family : sorted) {
    if (type == nullptr ? family->sends_like == nullptr : family == type) {
      radar.decoder = family->read(reader);
    }
  }
  for (const RadarFamily* family : sorted) {
    const std::string types =
        types_text(sorted, [&](const RadarFamily& other) { return is_alike(*family, other); });
    reader.refuse(keys_of(*family),
                  concat({"is a key of type ", types, "; must be left out here"}));
  }
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

/// Only for a sensor that receives the yaw rate.
void read_rotation_lead(TomlReader& reader, RadarConfiguration& radar) {
  if (!radar.decoder.rotation_lead_s()) {
    const std::string types = types_text(by_type(radar_families()), [](const RadarFamily& family) {
      return family.rotation_lead_s != nullptr;
    });
    reader.refuse(std::array{kRotationLead},
                  concat({"is a key of type ", types,
                          ", which receives the yaw rate; must be left out here"}));
    return;
  }
  reader.number(kRotationLead, radar.ego_motion.correction.rotation_lead_s, {-0.2, 0.2});
}

void read_calibration(TomlReader& reader, RadarConfiguration& radar) {
  DetectionCorrection& correction = radar.ego_motion.correction;
  read_rotation_lead(reader, radar);
  reader.number("azimuth_scale", correction.azimuth_scale, {0.9, 1.1});
  reader.number("stamp_offset_s", radar.stamp_offset_s, kStampOffsetsS);
  reader.number("doppler_offset_mps", correction.doppler_offset_mps, {-5.0, 5.0});
  reader.number("doppler_scale", correction.doppler_scale, kDopplerScales);
  reader.number("range_std_factor", correction.range_std_factor, {0.1, 10.0});
  reader.number("azimuth_std_factor", correction.azimuth_std_factor, {0.1, 10.0});
  reader.number("doppler_std_factor", correction.doppler_std_factor, {0.1, 10.0});
}

/// The tables of one radar that [calibrated] can replace.
void read_calibrated(TomlReader& reader, RadarConfiguration& radar) {
  TomlReader mount = reader.table("mount");
  read_mount(mount, radar.ego_motion.vehicle_from_radar, Presence::required);
  mount.finish();
  radar.ego_motion.correction.rotation_lead_s = radar.decoder.rotation_lead_s().value_or(0.0);
  TomlReader calibration = reader.table("calibration");
  read_calibration(calibration, radar);
  calibration.finish();
}

}  // namespace

bool share_channel(std::string_view a, std::string_view b) {
  const auto upper = [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  };
  return std::ranges::equal(a, b, {}, upper, upper);
}

bool is_interface_name(std::string_view text) {
  return !text.empty() && text.size() <= kMaxInterfaceName && text != "." && text != ".." &&
         text.find_first_of(" /:\n\t") == std::string_view::npos && plain_text(text) == text;
}

PlacedRadar read_radar(TomlReader reader, const EgoMotionOptions& defaults,
                       RadarFamilies families) {
  PlacedRadar placed{{}, reader.line_of("name"), reader.line_of("interface")};
  RadarConfiguration& radar = placed.radar;
  radar.ego_motion = defaults;
  reader.text("name", radar.name, kName, Presence::required);
  reader.text("interface", radar.interface, kInterface, Presence::required);
  reader.number("scan_timeout_s", radar.scan_timeout_s, {0.001, 0.06});
  read_decoder(reader, families, radar);
  read_calibrated(reader, radar);
  if (const double max_range_m = radar.decoder.family().max_range_m; max_range_m != 0.0) {
    radar.ego_motion.limits.max_range_m = max_range_m;
  }
  read_limits(reader.table("limits"), radar.ego_motion.limits);
  read_estimator(reader.table("estimator"), radar.ego_motion);
  reader.finish();
  return placed;
}

void read_calibrated(TomlReader reader, std::vector<PlacedRadar>& radars,
                     OdometryConfiguration& odometry) {
  read_slip_per_lateral_acceleration(reader, odometry);
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
