// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The files of config/: the manual is complete and correct, the examples load.
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/first_configuration.hpp"
#include "test/daemon/configuration_texts.hpp"

namespace cremed {
namespace {

const std::string kFolder = CREMED_SOURCE_DIR "/config/";

/// The options of a radar if it is of their family.
template <typename Options>
std::optional<Options> options_of(const RadarSettings& settings) {
  const auto* options = settings.as<Options>();
  return options != nullptr ? std::optional(*options) : std::nullopt;
}

// With structured bindings, a new part does not compile until it is compared here.
void check_same(const RadarConfiguration& radar, const RadarConfiguration& expected) {
  const auto& [name, interface, decoder, timeout_s, stamp_offset_s, ego_motion] = radar;
  CHECK(name == expected.name);
  CHECK(interface == expected.interface);
  CHECK(options_of<Ars408Options>(decoder) == options_of<Ars408Options>(expected.decoder));
  CHECK(options_of<BoschGprOptions>(decoder) == options_of<BoschGprOptions>(expected.decoder));
  CHECK(timeout_s == expected.scan_timeout_s);
  CHECK(stamp_offset_s == expected.stamp_offset_s);
  CHECK(ego_motion.vehicle_from_radar == expected.ego_motion.vehicle_from_radar);
  CHECK(ego_motion.limits == expected.ego_motion.limits);
  CHECK(ego_motion.correction == expected.ego_motion.correction);
  CHECK(ego_motion.registration == expected.ego_motion.registration);
  CHECK(ego_motion == expected.ego_motion);
}

void check_same(const Configuration& configuration, const Configuration& expected) {
  const auto& [radars, odometry, vehicle, output, live, logging] = configuration;
  CHECK(odometry == expected.odometry);
  CHECK(vehicle == expected.vehicle);
  CHECK(output == expected.output);
  CHECK(live == expected.live);
  CHECK(logging == expected.logging);
  REQUIRE(radars.size() == expected.radars.size());
  for (std::size_t i = 0; i < radars.size(); ++i) {
    check_same(radars[i], expected.radars[i]);
  }
}

std::vector<std::string> manual_lines() {
  std::ifstream file(kFolder + "cremed.toml");
  REQUIRE(file.good());
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    lines.push_back(line);
  }
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) {
    text += line + "\n";
  }
  return text;
}

/// "#key = value" and "#[table]" are commented-out TOML, "# text" is prose.
bool is_commented_out(const std::string& line) {
  return line.size() > 1 && line[0] == '#' && line[1] != ' ' && line[1] != '#';
}

std::string uncommented(const std::string& line) {
  return is_commented_out(line) ? line.substr(1) : line;
}

/// "table.key" of every key in the manual, set or commented out.
std::set<std::string> keys_of(const std::vector<std::string>& lines) {
  std::set<std::string> keys;
  std::string table;
  for (const std::string& commented : lines) {
    const std::string line = uncommented(commented);
    if (line.starts_with('[')) {
      const std::size_t begin = line.find_first_not_of('[');
      table = line.substr(begin, line.find(']') - begin) + ".";
    } else if (!line.starts_with('#') && line.find(" = ") != std::string::npos) {
      keys.insert(table + line.substr(0, line.find(" = ")));
    }
  }
  return keys;
}

TEST_CASE("the manual loads as it is and holds the defaults") {
  const Configuration configuration = load_configuration(kFolder + "cremed.toml");
  Configuration expected;
  RadarConfiguration& radar = expected.radars.emplace_back();
  radar.name = "front";
  radar.interface = "can0";
  radar.ego_motion.vehicle_from_radar = {3.412, 0.0, 0.0};
  radar.ego_motion.correction.rotation_lead_s = kArs408RotationLeadS;
  check_same(configuration, expected);
}

/// "table.key" of every key and table that the message about an unknown key of a table lists.
std::set<std::string> listed_by(const std::string& message) {
  const std::regex shape(R"(test\.toml:\d+: (.*)unknown_unknown_unknown: unknown key; (.*))");
  std::smatch parts;
  CAPTURE(message);
  REQUIRE(std::regex_match(message, parts, shape));
  const std::string list = parts[2];
  const std::regex quoted("\"([^\"]*)\"");
  std::set<std::string> keys;
  for (std::sregex_iterator key(list.begin(), list.end(), quoted); key != std::sregex_iterator();
       ++key) {
    keys.insert(parts[1].str() + (*key)[1].str());
  }
  return keys;
}

/// "table.key" of every key that there is, by an unknown one in each table of the manual.
std::set<std::string> known_keys() {
  std::vector<std::string> lines{""};  // The keys after it are those of no table.
  std::set<std::string> tables;
  for (const std::string& line : manual_lines()) {
    lines.push_back(uncommented(line));
  }
  for (const char* table : {"", ".outlier_ray", ".doppler", ".shared_errors"}) {
    lines.push_back(std::string("[radar.estimator") + table + "]");
  }
  for (const RadarFamily* family : radar_families()) {
    const std::string type(family->type);
    tables.insert("calibrated.a_" + type);
    lines.insert(lines.end(), {"[[radar]]", "name = \"a_" + type + "\"", "type = \"" + type + "\"",
                               "interface = \"bus_" + type + "\"", "[radar.mount]", "x_m = 2.0",
                               "y_m = 0.0", "yaw_rad = 0.0"});
  }
  std::set<std::string> keys;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i == 0 || lines[i].starts_with('[')) {
      std::vector<std::string> changed = lines;
      changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     "unknown_unknown_unknown = 1");
      keys.merge(listed_by(message_of(joined(changed))));
      const std::size_t begin = lines[i].find_first_not_of('[');
      tables.insert(i == 0 ? "" : lines[i].substr(begin, lines[i].find(']') - begin));
    }
  }
  std::erase_if(keys, [&](const std::string& key) { return tables.count(key) != 0; });
  return keys;
}

TEST_CASE("the manual names every key that there is, and no other") {
  const std::string common = "estimator.";
  const std::string own = "radar.estimator.";
  const std::set<std::string> known = known_keys();
  std::set<std::string> expected;
  for (const std::string& key : known) {
    if (key.starts_with(own)) {
      CHECK(known.count(common + key.substr(own.size())) == 1);
    } else if (key != "calibrated.left") {  // A table like [calibrated.front].
      expected.insert(key);
    }
  }
  CHECK(expected.size() >= 50);
  CHECK(keys_of(manual_lines()) == expected);
  CHECK_THAT(joined(manual_lines()), Catch::Contains("[radar.estimator]"));
}

TEST_CASE("each default that the manual shows is the default") {
  const std::vector<std::string> lines = manual_lines();
  const Configuration as_it_is = parse_configuration(joined(lines), "manual");
  std::string table;
  int tried = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    table = uncommented(lines[i]).starts_with('[') ? lines[i] : table;
    if (!is_commented_out(lines[i]) || table.starts_with('#')) {
      continue;  // Prose, or part of the second radar.
    }
    std::vector<std::string> changed = lines;
    changed[i] = uncommented(lines[i]);
    CAPTURE(changed[i]);
    check_same(parse_configuration(joined(changed), "manual"), as_it_is);
    ++tried;
  }
  CHECK(tried > 35);
}

TEST_CASE("with every comment sign removed, the manual's two radars have their defaults") {
  std::vector<std::string> lines = manual_lines();
  for (std::string& line : lines) {
    line = uncommented(line);
  }
  const Configuration configuration = parse_configuration(joined(lines), "manual");
  REQUIRE(configuration.radars.size() == 2);
  RadarConfiguration expected;
  expected.name = "left";
  expected.interface = "can1";
  expected.decoder = BoschGprOptions{};
  expected.ego_motion.vehicle_from_radar = {2.0, 0.8, 1.5708};
  check_same(configuration.radars[1], expected);
}

/// "0.01 to 1000" of a comment "... m, 0.01 to 1000, less than ..."; empty if it states no range.
std::string stated_range(const std::string& comment) {
  std::istringstream words(comment);
  std::string before;
  std::string range;
  for (std::string word; words >> word; before = word) {
    std::string after;
    if (word == "to" && words >> after && std::isdigit(before.back()) != 0) {
      after.erase(after.find_last_not_of(".,;") + 1);
      range = std::string(before).append(" to ").append(after);
      word = after;
    }
  }
  return range;
}

TEST_CASE("each range that the manual states is the range") {
  std::vector<std::string> lines = manual_lines();
  std::string comment;
  int tried = 0;
  for (std::string& line : lines) {
    line = uncommented(line);
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const bool is_prose = lines[i].starts_with('#');
    const std::string range = is_prose ? "" : stated_range(comment);
    comment = is_prose ? comment.append(lines[i], 1) : "";
    if (range.empty() || lines[i].find(" = ") == std::string::npos) {
      continue;
    }
    std::vector<std::string> changed = lines;
    const std::size_t value = lines[i].find(" = ") + 3;
    const bool is_list = lines[i][value] == '[';
    changed[i] = lines[i].substr(0, value) + (is_list ? "[1000000000]" : "1000000000");
    CAPTURE(changed[i]);
    CHECK_THAT(message_of(joined(changed)), Catch::Contains(" from " + range));
    ++tried;
  }
  CHECK(tried >= 36);
}

TEST_CASE("the nuScenes files have five radars, which look where their names say") {
  struct Side {
    const char* name;
    double yaw_rad;
    double y_sign;
  };
  const std::vector<Side> sides = {{"front", 0.0, 0.0},
                                   {"left", 1.57, 1.0},
                                   {"right", -1.57, -1.0},
                                   {"rear_left", 3.06, 1.0},
                                   {"rear_right", -3.06, -1.0}};
  const std::string file = GENERATE("nuscenes-boston.toml", "nuscenes-singapore.toml");
  const auto radars = load_configuration(kFolder + file).radars;
  REQUIRE(radars.size() == sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    CAPTURE(file, sides[i].name);
    const Pose2& mount = radars[i].ego_motion.vehicle_from_radar;
    CHECK(radars[i].name == sides[i].name);
    CHECK(mount.yaw_rad == Approx(sides[i].yaw_rad).margin(0.03));
    CHECK(mount.y_m * sides[i].y_sign >= 0.0);
    CHECK((mount.x_m < 0.0) == (std::abs(sides[i].yaw_rad) > 3.0));
  }
}

TEST_CASE("a file that cannot be read is a configuration error with its path") {
  const std::string missing = std::string(CREMED_BINARY_DIR) + "/no-such-file.toml";
  CHECK_THROWS_WITH(load_configuration(missing),
                    Catch::StartsWith(missing + ": cannot be read: No such file or directory; ") &&
                        Catch::EndsWith(std::string(kWriteFirst)));
  CHECK_THROWS_WITH(load_configuration(CREMED_BINARY_DIR),
                    Catch::Contains(": cannot be read: Is a directory; must be a readable"));
  CHECK_THROWS_WITH(load_configuration("/dev/zero"),
                    Catch::StartsWith("/dev/zero: cannot be read: is a pipe, socket or device; "));
}

TEST_CASE("a FIFO is refused, and nobody waits for its writer") {
  const std::string path = std::string(CREMED_BINARY_DIR) + "/test_configuration_files.fifo";
  std::remove(path.c_str());
  REQUIRE(::mkfifo(path.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(load_configuration(path),
                    Catch::StartsWith(path + ": cannot be read: is a pipe, socket or device; "));
  std::remove(path.c_str());
}

TEST_CASE("a file gives what its text gives, with its path in errors") {
  const std::string path = std::string(CREMED_BINARY_DIR) + "/test_configuration_files.toml";
  std::ofstream(path, std::ios::binary) << kArs408 << "sensor_id = 4\n";
  check_same(load_configuration(path), parse_configuration(kArs408 + "sensor_id = 4\n", ""));
  std::ofstream(path, std::ios::binary) << kArs408 << "sensor_id = 9\n";
  CHECK_THROWS_AS(load_configuration(path), ConfigurationError);
  CHECK_THROWS_WITH(load_configuration(path), Catch::StartsWith(path + ":6: radar.sensor_id: "));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace cremed
