// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>
#include <utility>

#include "daemon/configuration_estimator.hpp"
#include "daemon/configuration_radar.hpp"
#include "daemon/message_text.hpp"
#include "daemon/toml_document.hpp"
#include "daemon/toml_reader.hpp"

namespace cremed {
namespace {

constexpr std::array<std::string_view, 6> kLevels = {"trace", "debug", "info",
                                                     "warn",  "error", "off"};

constexpr std::array<std::string_view, 3> kRealTimePolicies = {"prefer", "require", "off"};
constexpr std::int64_t kMinReceiveBuffer = 1 << 16;
constexpr std::int64_t kMaxReceiveBuffer = 1 << 26;

bool is_any(std::string_view /*text*/) { return true; }

constexpr TextRule kLcmUrl = {is_lcm_url, kLcmUrlWanted};
constexpr TextRule kPath = {is_any, "a path, or \"\" for none"};
constexpr TextRule kSource = {
    is_any, "the name of a radar, \"fused\" where there are two or more, or \"\" for the first"};

void check_output(TomlReader& reader, const Configuration& configuration) {
  const OutputConfiguration& output = configuration.output;
  const auto& radars = configuration.radars;
  const bool is_that_of_all = output.tum_source == kFusedSource && is_fused(configuration);
  if (!output.tum_source.empty() && !is_that_of_all &&
      std::none_of(radars.begin(), radars.end(),
                   [&](const auto& radar) { return radar.name == output.tum_source; })) {
    reader.report("tum_source",
                  concat({"is \"", printable(output.tum_source), "\"; must be ", kSource.wanted}));
  }
  if (!output.tum.empty() && output.tum == output.csv) {
    reader.report("tum", "is the file of csv as well; must be another path");
  }
}

void read_output(TomlReader& reader, OutputConfiguration& output) {
  reader.text("lcm_url", output.lcm_url, kLcmUrl);
  reader.text("csv", output.csv, kPath);
  reader.text("tum", output.tum, kPath);
  reader.text("tum_source", output.tum_source, kSource);
  reader.boolean("publish_scans", output.publish_scans);
  reader.finish();
}

void read_fused(TomlReader reader, FusedOptions& fused) {
  reader.boolean("enabled", fused.enabled);
  reader.number("acceleration_std_mps2", fused.acceleration_std_mps2, {0.0, 100.0});
  reader.number("yaw_acceleration_std_radps2", fused.yaw_acceleration_std_radps2, {0.0, 100.0});
  reader.number("side_slip_std_rad", fused.side_slip_std_rad, {0.0, 1.0});
  reader.number("side_slip_walk_radps", fused.side_slip_walk_radps, {0.0, 1.0});
  reader.number("max_innovation", fused.max_innovation, {1.0, 1000.0});
  reader.finish();
}

void read_live(TomlReader reader, LiveConfiguration& live) {
  if (const auto policy = reader.choice("realtime", kRealTimePolicies)) {
    live.real_time = static_cast<RealTimePolicy>(*policy);
  }
  reader.integer("receive_buffer_bytes", live.socket.receive_buffer_bytes, kMinReceiveBuffer,
                 kMaxReceiveBuffer);
  reader.boolean("hardware_stamps", live.socket.hardware_stamps);
  reader.number("max_latency_s", live.max_latency_s, {0.05, 10.0});
  reader.finish();
}

void read_logging(TomlReader reader, LoggingConfiguration& logging) {
  if (const auto level = reader.choice("level", kLevels)) {
    logging.level = kLevels[*level];
  }
  reader.finish();
}

std::vector<PlacedRadar> read_radars(TomlReader& reader, const EgoMotionOptions& defaults) {
  std::vector<TomlReader> tables = reader.tables("radar");
  if (tables.size() > kMaxRadars) {
    reader.report("radar", concat({"has ", std::to_string(tables.size()),
                                   " tables; must be at most ", std::to_string(kMaxRadars)}));
    tables.clear();
  }
  std::vector<PlacedRadar> radars;
  radars.reserve(tables.size());
  for (TomlReader& table : tables) {
    radars.push_back(read_radar(std::move(table), defaults));
  }
  return radars;
}

Configuration read_configuration(const toml::table& table, ReadContext& context) {
  TomlReader reader(&table, "", 1, context);
  Configuration configuration;
  EgoMotionOptions defaults;
  read_estimator(reader.table("estimator"), defaults);
  const std::vector<PlacedRadar> radars = read_radars(reader, defaults);
  for (const PlacedRadar& placed : radars) {
    configuration.radars.push_back(placed.radar);
  }
  read_fused(reader.table("fused"), configuration.fused);
  TomlReader output = reader.table("output");
  read_output(output, configuration.output);
  read_live(reader.table("live"), configuration.live);
  read_logging(reader.table("logging"), configuration.logging);
  reader.finish();
  if (context.diagnostics.empty()) {  // A wrong value kept its default, which clashes easily.
    check_radars(radars, context.diagnostics);
    check_output(output, configuration);
  }
  return configuration;
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

[[noreturn]] void throw_unreadable(const std::string& path, int error) {
  throw ConfigurationError(
      concat({path, ": cannot be read: ", std::generic_category().message(error),
              "; must be a readable TOML file"}));
}

}  // namespace

bool is_fused(const Configuration& configuration) {
  return configuration.fused.enabled && configuration.radars.size() > 1;
}

bool is_lcm_url(std::string_view text) {
  const std::size_t colon = text.find("://");
  return text == "none" || (colon != std::string_view::npos && colon > 0 &&
                            text.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == colon);
}

Configuration parse_configuration(std::string_view toml, const std::string& file_name) {
  ReadContext context{Diagnostics(file_name), nullptr};
  Configuration configuration;
  if (const auto table = parse_toml(toml, context.diagnostics)) {
    configuration = read_configuration(*table, context);
  }
  if (!context.diagnostics.empty()) {
    throw ConfigurationError(context.diagnostics.text());
  }
  return configuration;
}

Configuration load_configuration(const std::string& path) {
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) {
    throw_unreadable(path, errno);
  }
  std::string text(kMaxTomlBytes + 1, '\0');  // One byte more than allowed shows that it is more.
  errno = 0;
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  if (std::ferror(file.get()) != 0) {
    throw_unreadable(path, errno);
  }
  return parse_configuration(text, path);
}

std::set<std::string> known_configuration_keys() {
  std::set<std::string> keys;
  ReadContext context{Diagnostics(""), &keys};
  if (const auto table = parse_toml("[[radar]]\ntype = \"ars408\"\n[[radar]]\ntype = \"bosch_gpr\"",
                                    context.diagnostics)) {
    read_configuration(*table, context);  // What it reports as missing does not matter here.
  }
  return keys;
}

}  // namespace cremed
