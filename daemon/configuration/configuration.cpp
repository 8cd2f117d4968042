// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/configuration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "daemon/configuration/configuration_radar.hpp"
#include "daemon/configuration/configuration_sections.hpp"
#include "daemon/configuration/first_configuration.hpp"
#include "daemon/configuration/lcm_url.hpp"
#include "daemon/configuration/toml_document.hpp"
#include "daemon/configuration/toml_reader.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr std::array<std::string_view, 6> kLevels = {"trace", "debug", "info",
                                                     "warn",  "error", "off"};

constexpr std::array<std::string_view, 3> kRealTimePolicies = {"prefer", "require", "off"};
/// A list takes 75 ms, and its odometry may wait for another radar's list.
constexpr double kLeastLatencyS = 0.2;
constexpr std::int64_t kMinReceiveBuffer = 1 << 16;
constexpr std::int64_t kMaxReceiveBuffer = 1 << 26;

bool is_any(std::string_view /*text*/) { return true; }

constexpr TextRule kLcmUrl = {is_lcm_url, kLcmUrlWanted};
constexpr TextRule kPath = {is_any, "a path, or \"\" for none"};
constexpr TextRule kSource = {
    is_any,
    "the name of a radar, \"odometry\" unless that is off, \"fused\" for the same of two radars or "
    "more, or \"\""};

/// An LCM channel name, at most 63 characters, not one of cremed's own.
bool is_free_channel(std::string_view text) {
  constexpr std::size_t kLongest = 63;
  return text.size() <= kLongest && !text.starts_with("CREMED_") &&
         std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; });
}

constexpr TextRule kChannel = {
    is_free_channel,
    "a channel such as \"/odometry#nav_msgs.Odometry\", up to 63 letters, digits or signs and not "
    "CREMED_..., or \"\" for none"};

bool is_source(std::string_view source, const Configuration& configuration) {
  if (source == kOdometrySource) {
    return configuration.odometry.enabled;
  }
  if (source == kFusedSource) {
    return is_fused(configuration);
  }
  return source.empty() ||
         std::ranges::count(configuration.radars, source, &RadarConfiguration::name) != 0;
}

void check_output(TomlReader& reader, const Configuration& configuration) {
  const OutputConfiguration& output = configuration.output;
  if (!is_source(output.tum_source, configuration)) {
    reader.report("tum_source",
                  concat({"is \"", printable(output.tum_source), "\"; must be ", kSource.wanted}));
  }
  const auto check_path = [&](std::string_view key, const std::string& path,
                              std::string_view other_key, const std::string& other) {
    if (!path.empty() && path == other) {
      reader.report(key, concat({"is the file of ", other_key, " as well; must be another path"}));
    }
  };
  check_path("odometry", output.odometry, "csv", output.csv);
  check_path("tum", output.tum, "csv", output.csv);
  check_path("tum", output.tum, "odometry", output.odometry);
  if (!output.nav_msgs_odometry.empty() && !configuration.odometry.enabled) {
    reader.report("nav_msgs_odometry",
                  "is to be published, but odometry.enabled = false; must be \"\"");
  }
  if (!output.odometry.empty() && !configuration.odometry.enabled) {
    reader.report("odometry", "is to be written, but odometry.enabled = false; must be \"\"");
  }
}

void read_output(TomlReader& reader, OutputConfiguration& output) {
  reader.text("lcm_url", output.lcm_url, kLcmUrl);
  reader.text("csv", output.csv, kPath);
  reader.text("odometry", output.odometry, kPath);
  reader.text("tum", output.tum, kPath);
  reader.text("tum_source", output.tum_source, kSource);
  reader.text("nav_msgs_odometry", output.nav_msgs_odometry, kChannel);
  reader.boolean("publish_scans", output.publish_scans);
  reader.finish();
}

void read_live(TomlReader& reader, LiveConfiguration& live) {
  if (const auto policy = reader.choice("realtime", kRealTimePolicies)) {
    live.real_time = static_cast<RealTimePolicy>(*policy);
  }
  reader.integer("receive_buffer_bytes", live.socket.receive_buffer_bytes, kMinReceiveBuffer,
                 kMaxReceiveBuffer);
  reader.boolean("hardware_stamps", live.socket.hardware_stamps);
  reader.number("max_latency_s", live.max_latency_s, {kLeastLatencyS, 10.0});
  reader.finish();
}

/// A negative stamp_offset_s makes each scan older.
void check_live(TomlReader& reader, const Configuration& configuration) {
  const double max_latency_s = configuration.live.max_latency_s;
  for (const RadarConfiguration& radar : configuration.radars) {
    // 0.2 + 0.4 is more than 0.6.
    const double least_s = std::round((kLeastLatencyS - radar.stamp_offset_s) * 1e6) / 1e6;
    if (max_latency_s < least_s) {
      reader.report("max_latency_s",
                    concat({"is ", digits(max_latency_s), " while stamp_offset_s of ",
                            in_quotes(radar.name), " is ", digits(radar.stamp_offset_s),
                            ": every scan would be stale; must be at least ", digits(least_s)}));
    }
  }
}

void read_logging(TomlReader reader, LoggingConfiguration& logging) {
  if (const auto level = reader.choice("level", kLevels)) {
    logging.level = kLevels[*level];
  }
  reader.finish();
}

std::vector<PlacedRadar> read_radars(TomlReader& reader, const EgoMotionOptions& defaults,
                                     RadarFamilies families) {
  std::vector<TomlReader> tables = reader.tables("radar", concat({": ", kWriteFirst}));
  if (tables.size() > kMaxRadars) {
    reader.report("radar", concat({"has ", std::to_string(tables.size()),
                                   " tables; must be at most ", std::to_string(kMaxRadars)}));
    tables.clear();
  }
  std::vector<PlacedRadar> radars;
  radars.reserve(tables.size());
  for (TomlReader& table : tables) {
    radars.push_back(read_radar(std::move(table), defaults, families));
  }
  return radars;
}

Configuration read_configuration(const toml::table& table, Diagnostics& diagnostics,
                                 RadarFamilies families) {
  TomlReader reader(&table, "", 1, diagnostics);
  Configuration configuration;
  EgoMotionOptions defaults;
  read_estimator(reader.table("estimator"), defaults);
  std::vector<PlacedRadar> radars = read_radars(reader, defaults, families);
  read_odometry(reader.table("odometry"), configuration.odometry);
  read_calibrated(reader.table("calibrated"), radars, configuration.odometry);
  for (const PlacedRadar& placed : radars) {
    configuration.radars.push_back(placed.radar);
  }
  TomlReader vehicle = reader.table("vehicle");
  read_vehicle(vehicle, configuration.vehicle, configuration.odometry.filter.vehicle);
  TomlReader output = reader.table("output");
  read_output(output, configuration.output);
  TomlReader live = reader.table("live");
  read_live(live, configuration.live);
  read_logging(reader.table("logging"), configuration.logging);
  reader.finish();
  // A wrong value keeps its default, which would cause false clashes.
  if (diagnostics.empty()) {
    check_radars(radars, diagnostics);
    check_vehicle(vehicle, configuration);
    check_output(output, configuration);
    check_live(live, configuration);
  }
  return configuration;
}

}  // namespace

bool is_fused(const Configuration& configuration) {
  return configuration.odometry.enabled && configuration.radars.size() > 1;
}

std::optional<std::size_t> tum_radar(const Configuration& configuration) {
  const std::string& source = configuration.output.tum_source;
  const auto& radars = configuration.radars;
  const auto found = std::ranges::find(radars, source, &RadarConfiguration::name);
  if (found != radars.end()) {
    return found - radars.begin();
  }
  return source.empty() && !is_fused(configuration) ? std::optional<std::size_t>(0) : std::nullopt;
}

Configuration parse_configuration(std::string_view toml, const std::string& file_name,
                                  RadarFamilies families) {
  Diagnostics diagnostics(file_name);
  Configuration configuration;
  if (const auto table = parse_toml(toml, diagnostics)) {
    configuration = read_configuration(*table, diagnostics, families);
  }
  if (!diagnostics.empty()) {
    throw ConfigurationError(diagnostics.text());
  }
  return configuration;
}

Configuration load_configuration(const std::string& path) {
  try {
    return parse_configuration(read_toml(path), path);
  } catch (const std::system_error& error) {
    const bool is_absent = error.code() == std::errc::no_such_file_or_directory;
    const std::string why = error.code() == std::errc::not_supported
                                ? "is a pipe, socket or device"
                                : std::generic_category().message(error.code().value());
    throw ConfigurationError(
        concat({path, ": cannot be read: ", why, "; must be a readable TOML file",
                is_absent ? concat({": ", kWriteFirst}) : ""}));
  }
}

}  // namespace cremed
