// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The files of config/: the manual is complete and correct, the examples load.
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
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

// With structured bindings, a new field does not compile until it is added here.
void write(std::ostream& out, const Ars408Options& options) {
  const auto& [sensor_id, output, states, dyn_props, existence, inverted, feedback, model] =
      options;
  out << "ars408 " << static_cast<int>(model) << ' ' << int{sensor_id} << ' '
      << static_cast<int>(output) << ' ' << states << ' ' << int{dyn_props} << ' ' << int{existence}
      << ' ' << inverted << feedback << '\n';
}

void write(std::ostream& out, const BoschGprOptions& options) {
  const auto& [base_id, info_id, crc_policy, azimuth, doppler, existence] = options;
  out << "gpr " << base_id << ' ' << info_id << ' ' << static_cast<int>(crc_policy) << ' '
      << azimuth << ' ' << doppler << ' ' << existence << '\n';
}

void write(std::ostream& out, const RegistrationOptions& options) {
  const auto& [freedom, scale, doppler_scale, iterations, work, likelihood, ray, doppler, errors] =
      options;
  out << freedom << ' ' << scale << ' ' << doppler_scale << ' ' << iterations << ' ' << work << ' '
      << static_cast<int>(likelihood);
  const auto& [weight, min_range, max_range, field_of_view] = ray;
  out << "\nray " << weight << ' ' << min_range << ' ' << max_range << ' ' << field_of_view;
  const auto& [enabled, both_scans, stamp_std, moving_weight, moving_std] = doppler;
  out << "\ndoppler " << enabled << ' ' << both_scans << ' ' << stamp_std << ' ' << moving_weight
      << ' ' << moving_std;
  const auto& [offset, mount_yaw, velocity, scale_std, acceleration, yaw_acceleration, rounding] =
      errors;
  out << "\nshared " << offset << ' ' << mount_yaw << ' ' << velocity << ' ' << scale_std << ' '
      << acceleration << ' ' << yaw_acceleration << ' ' << rounding;
}

void write(std::ostream& out, const EgoMotionOptions& options) {
  const auto& [mount, limits, correction, registration, min_targets, gap, standstill, speed,
               yaw_rate, std_m, std_rad] = options;
  const auto& [x, y, yaw] = mount;
  const auto& [min_range, max_range, azimuth, rcs] = limits;
  const auto& [lead, azimuth_scale, doppler_offset, doppler_scale, range_factor, azimuth_factor,
               doppler_factor] = correction;
  out << "correction " << lead << ' ' << azimuth_scale << ' ' << doppler_offset << ' '
      << doppler_scale << ' ' << range_factor << ' ' << azimuth_factor << ' ' << doppler_factor
      << '\n';
  out << "mount " << x << ' ' << y << ' ' << yaw << "\nlimits " << min_range << ' ' << max_range
      << ' ' << azimuth << ' ' << rcs << "\nestimator " << min_targets << ' ' << gap << ' '
      << standstill << ' ' << speed << ' ' << yaw_rate << ' ' << std_m << ' ' << std_rad << ' ';
  write(out, registration);
}

std::string text_of(const RadarConfiguration& radar) {
  std::ostringstream out;
  out.precision(17);
  const auto& [name, interface, decoder, timeout, stamp_offset, ego_motion] = radar;
  out << name << ' ' << interface << ' ' << timeout << ' ' << stamp_offset << '\n';
  if (const auto* ars408 = decoder.as<Ars408Options>()) {
    write(out, *ars408);
  } else {
    write(out, *decoder.as<BoschGprOptions>());
  }
  write(out, ego_motion);
  return out.str();
}

std::ostream& operator<<(std::ostream& out, const OrnsteinUhlenbeck& noise) {
  const auto& [std, time_s] = noise;
  return out << std << ' ' << time_s;
}

std::ostream& operator<<(std::ostream& out, const ErrorProcess& error) {
  return out << OrnsteinUhlenbeck{error.std, error.time_s};
}

std::string text_of(const OdometryConfiguration& odometry) {
  std::ostringstream out;
  out.precision(17);
  const auto& [enabled, state_file, o] = odometry;
  out << enabled << '|' << state_file << '\n'
      << o.acceleration << ' ' << o.yaw_acceleration << ' ' << o.slip_std_rad << ' ' << o.slip_walk
      << ' ' << o.body_velocity << ' ' << o.start_speed_std_mps << ' ' << o.start_yaw_rate_std_radps
      << '\n'
      << o.slip_per_lateral_acceleration << ' ' << o.slip_per_lateral_acceleration_std << ' '
      << o.lever_std_m << ' ' << o.mount_yaw_std_rad << ' ' << o.mount_yaw_walk << ' '
      << o.doppler_scale_std << ' ' << o.doppler_std_mps << ' ' << o.doppler_x << ' ' << o.doppler_y
      << ' ' << o.offset << ' ' << o.azimuth_scale_std << '\n'
      << o.min_targets << ' ' << o.max_doppler_nis << ' ' << o.max_position_nis << ' '
      << o.standstill_mps << ' ' << o.predicted_s << ' ' << o.lost_s << ' ' << o.anchor_period_s
      << ' ' << o.max_lateness_s << ' ' << o.max_gap_s << ' ' << o.rate_hz << '\n';
  const VehicleOptions& v = o.vehicle;
  for (const VehicleSignalOptions& signal : {v.speed, v.yaw_rate}) {
    out << signal.is_used << ' ' << signal.delay_s << ' ' << signal.scale_std << ' ' << signal.error
        << ' ';
  }
  out << v.yaw_rate_bias_std_radps << '\n';
  return out.str();
}

std::string text_of(const VehicleConfiguration& vehicle) {
  const auto& [interface, ids] = vehicle;
  return interface + "|" + std::to_string(ids[0].value_or(0)) + "|" +
         std::to_string(ids[1].value_or(0)) + "\n";
}

std::string text_of(const Configuration& configuration) {
  const auto& [radars, odometry, vehicle, output, live, logging] = configuration;
  std::string text = text_of(odometry) + text_of(vehicle);
  for (const RadarConfiguration& radar : radars) {
    text += text_of(radar) + "\n";
  }
  const auto& [lcm_url, csv, odometry_csv, tum, tum_source, nav_msgs, publish_scans] = output;
  const auto& [real_time, socket, max_latency] = live;
  const auto& [receive_buffer, hardware_stamps] = socket;
  const auto& [level] = logging;
  text += std::to_string(static_cast<int>(real_time)) + "|" + std::to_string(receive_buffer) + "|" +
          std::to_string(hardware_stamps) + "|" + std::to_string(max_latency) + "|";
  return text + lcm_url + "|" + csv + "|" + odometry_csv + "|" + tum + "|" + tum_source + "|" +
         nav_msgs + "|" + std::to_string(publish_scans) + "|" + level;
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
  CHECK(text_of(configuration) == text_of(expected));
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
  const std::string as_it_is = text_of(parse_configuration(joined(lines), "manual"));
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
    CHECK(text_of(parse_configuration(joined(changed), "manual")) == as_it_is);
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
  CHECK(text_of(configuration.radars[1]) == text_of(expected));
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

struct Place {
  const char* name;
  const char* interface;
  Pose2 mount;
};

double azimuth_scale_of(std::string_view radar) {
  return radar == "front" ? 1.007 : radar.starts_with("rear") ? 1.012 : 1.0;
}

void check_nuscenes(const std::string& file, const std::vector<Place>& places) {
  const Configuration configuration = load_configuration(kFolder + file);
  REQUIRE(configuration.radars.size() == places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    RadarConfiguration expected;
    Ars408Options sensor;
    sensor.keep_invalid_states = 0x39F11;  // 0, 4, 8 to 12, 15 to 17
    expected.decoder = sensor;
    expected.name = places[i].name;
    expected.interface = places[i].interface;
    expected.ego_motion.vehicle_from_radar = places[i].mount;
    expected.ego_motion.correction.rotation_lead_s = kArs408RotationLeadS;
    expected.ego_motion.correction.azimuth_scale = azimuth_scale_of(places[i].name);
    expected.ego_motion.correction.doppler_scale = 1.004;
    expected.ego_motion.correction.azimuth_std_factor = 0.7;
    RegistrationOptions& registration = expected.ego_motion.registration;
    registration.degrees_of_freedom = 2;
    registration.outlier_ray.weight = 0.5;
    registration.start_scale = 5.0;
    CHECK(text_of(configuration.radars[i]) == text_of(expected));
  }
}

TEST_CASE("the nuScenes files have five radars where they are on the cars") {
  check_nuscenes("nuscenes-boston.toml", {
                                             {"front", "can0", {3.412, 0.0, 0.00142}},
                                             {"left", "can1", {2.422, 0.8, 1.58637}},
                                             {"right", "can2", {2.422, -0.8, -1.57516}},
                                             {"rear_left", "can3", {-0.562, 0.628, 3.05431}},
                                             {"rear_right", "can4", {-0.562, -0.618, -3.06559}},
                                         });
  check_nuscenes("nuscenes-singapore.toml",
                 {
                     {"front", "can0", {3.412, 0.0, -0.01045}},
                     {"left", "can1", {2.422, 0.8, 1.55612}},
                     {"right", "can2", {2.422, -0.8, -1.57599}},
                     {"rear_left", "can3", {-0.562, 0.628, 3.06197}},
                     {"rear_right", "can4", {-0.562, -0.618, -3.073699346}},
                 });
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
  CHECK(text_of(load_configuration(path)) ==
        text_of(parse_configuration(kArs408 + "sensor_id = 4\n", "")));
  std::ofstream(path, std::ios::binary) << kArs408 << "sensor_id = 9\n";
  CHECK_THROWS_AS(load_configuration(path), ConfigurationError);
  CHECK_THROWS_WITH(load_configuration(path), Catch::StartsWith(path + ":6: radar.sensor_id: "));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace cremed
