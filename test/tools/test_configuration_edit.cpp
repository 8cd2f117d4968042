// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "daemon/process/replaced_file.hpp"
#include "tools/eval/calibrate/configuration_edit.hpp"
#include "tools/eval/temporary_folder.hpp"

namespace cremed {
namespace {

const std::string kHead = "[[radar]]\nname = \"front\"\ntype = \"ars408\"\ninterface = \"can0\"\n";
const std::string kMount = "mount = { x_m = 3.4, y_m = 0.1, yaw_rad = 0.02 } # measured\n";

/// The values of one radar with a new yaw, rotation lead and Doppler offset.
std::vector<CalibratedValue> new_values(const RadarConfiguration& radar) {
  RadarConfiguration found = radar;
  found.ego_motion.vehicle_from_radar.yaw_rad = -0.0123;
  found.ego_motion.correction.rotation_lead_s = 0.035;
  found.ego_motion.correction.doppler_offset_mps = -0.25;
  return changed_values(radar, found);
}

std::string edited(const std::string& text) {
  std::vector<std::vector<CalibratedValue>> radars;
  for (const RadarConfiguration& radar : parse_configuration(text, "test").radars) {
    radars.push_back(new_values(radar));
  }
  return edited_configuration(text, radars);
}

struct Row {
  std::string before;
  std::string after;
};

TEST_CASE("the vehicle's value goes into [odometry], or where it is already") {
  const auto row = GENERATE_COPY(
      Row{kHead + kMount, kHead + kMount + "[odometry]\nslip_per_lateral_acceleration = 0.00310\n"},
      Row{"[odometry]\nrate_hz = 50\n" + kHead + kMount,
          "[odometry]\nslip_per_lateral_acceleration = 0.00310\nrate_hz = 50\n" + kHead + kMount},
      Row{kHead + kMount + "[odometry]\n#slip_per_lateral_acceleration = 0.0\nrate_hz = 50\n",
          kHead + kMount + "[odometry]\nslip_per_lateral_acceleration = 0.00310\nrate_hz = 50\n"},
      Row{"odometry = { slip_per_lateral_acceleration = 0.001 }\n" + kHead + kMount,
          "odometry = { slip_per_lateral_acceleration = 0.00310 }\n" + kHead + kMount},
      Row{kHead + kMount + "[calibrated]\nslip_per_lateral_acceleration = 0.002 # old\n",
          kHead + kMount + "[calibrated]\nslip_per_lateral_acceleration = 0.00310 # old\n"});
  const Configuration before = parse_configuration(row.before, "test");
  OdometryOptions found = before.odometry.filter;
  found.slip_per_lateral_acceleration = 0.0031;
  CHECK(edited_configuration(row.before, {{}},
                             changed_vehicle_values(before.odometry.filter, found)) == row.after);
}

TEST_CASE("new values go where the old ones are, and all else stays") {
  const std::string new_mount = "mount = { x_m = 3.4, y_m = 0.1, yaw_rad = -0.01230 } # measured\n";
  const auto row = GENERATE_COPY(
      Row{kHead + "# why\n" + kMount + "scan_timeout_s = 0.02\n",  // no table: dotted keys
          kHead + "# why\n" + new_mount +
              "calibration.doppler_offset_mps = -0.250\ncalibration.rotation_lead_s = 0.0350\n"
              "scan_timeout_s = 0.02\n"},
      Row{kHead + kMount + "calibration = { doppler_scale = 1.005 }",
          kHead + new_mount +
              "calibration = { doppler_offset_mps = -0.250, rotation_lead_s = 0.0350, "
              "doppler_scale = 1.005 }"},
      Row{kHead + kMount + "calibration = {}\n",
          kHead + new_mount +
              "calibration = { doppler_offset_mps = -0.250, rotation_lead_s = 0.0350 }\n"},
      Row{kHead + kMount + "  calibration.doppler_offset_mps=0.1# old\n",
          kHead + new_mount +
              "  calibration.doppler_offset_mps=-0.250# old\ncalibration.rotation_lead_s = "
              "0.0350\n"},
      Row{kHead + "[radar.mount]\nx_m = 3\ny_m = 0 # left\nyaw_rad = +2e-2\n[radar.calibration]\n"
                  "# m/s\n#doppler_offset_mps = 0.0 # 0: none\n\n[live]\nrealtime = \"off\"\n",
          kHead + "[radar.mount]\nx_m = 3\ny_m = 0 # left\nyaw_rad = -0.01230\n"
                  "[radar.calibration]\nrotation_lead_s = 0.0350\n"
                  "# m/s\ndoppler_offset_mps = -0.250 # 0: none\n\n[live]\nrealtime = \"off\"\n"},
      Row{"radar = [{ name = \"front\", type = \"ars408\", interface = \"can0\", mount = { x_m = "
          "3.4, "
          "y_m = 0.1, yaw_rad = 0.02 } }]\n",
          "radar = [{ calibration.doppler_offset_mps = -0.250, calibration.rotation_lead_s = "
          "0.0350, "
          "name = \"front\", type = \"ars408\", interface = \"can0\", mount = { x_m = 3.4, "
          "y_m = 0.1, yaw_rad = -0.01230 } }]\n"},
      Row{"[calibrated.front]\nyaw_rad = 0.3\n" + kHead + kMount + "[radar.calibration]",
          "[calibrated.front]\nyaw_rad = -0.01230\n" + kHead + kMount +
              "[radar.calibration]\ndoppler_offset_mps = -0.250\nrotation_lead_s = 0.0350"});
  CHECK(edited(row.before) == row.after);
}

TEST_CASE("line ends, byte order mark and characters of comments stay") {
  std::string text =
      "\xEF\xBB\xBF# Gr\xC3\xBC\xC3\x9F"
      "e\n" +
      kHead + kMount + "[radar.calibration] # \xC3\xA9\n#rotation_lead_s = 0.04\n";
  for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) {
    text.replace(i, 1, "\r\n");
  }
  const std::string result = edited(text);
  CAPTURE(result);
  CHECK(
      result.starts_with("\xEF\xBB\xBF# Gr\xC3\xBC\xC3\x9F"
                         "e\r\n"));
  CHECK_THAT(result, Catch::Contains("yaw_rad = -0.01230 } # measured\r\n"));
  CHECK_THAT(result, Catch::Contains("# \xC3\xA9\r\ndoppler_offset_mps = -0.250\r\n"
                                     "rotation_lead_s = 0.0350\r\n"));
}

TEST_CASE("each radar gets its own values") {
  const std::string rear =
      "[[radar]]\nname = \"rear\"\ntype = \"bosch_gpr\"\ninterface = \"can1\"\n"
      "mount.x_m = -0.5\nmount.y_m = 0.0\nmount.yaw_rad = 3.0\n";
  const std::string text = kHead + kMount + rear;
  const Configuration configuration = parse_configuration(text, "test");
  RadarConfiguration found = configuration.radars[1];
  found.ego_motion.vehicle_from_radar.yaw_rad = 3.1;
  const std::string result =
      edited_configuration(text, {{}, changed_values(configuration.radars[1], found)});
  CHECK(result == kHead + kMount + rear.substr(0, rear.size() - 4) + "3.10000\n");
}

TEST_CASE("a way of writing that the editor does not know is refused") {
  const std::string text =
      kHead + kMount +
      "\"calibration\" . doppler_scale = 1.01\ncalibration . \"rotation_lead_s\" = 0\n";
  const auto read = [&] { return parse_configuration(edited(text), "edited"); };
  CHECK(read().radars[0].ego_motion.correction.rotation_lead_s == 0.035);
  const std::string in_line =
      "radar = [{ name = \"front\", type = \"ars408\", interface = \"can0\", "
      "mount.x_m = 1, mount.y_m = 0, mount.yaw_rad = 1, "
      "calibration.doppler_scale = 1 }]\n";
  CHECK_THROWS_WITH(edited(in_line), Catch::Contains("nothing was written"));
}

TEST_CASE("a file is replaced through a link, with its permissions, and no other is left") {
  const TemporaryFolder folder;
  const std::string file = folder.file("real.toml");
  std::ofstream(file) << "old";
  REQUIRE(::chmod(file.c_str(), 0640) == 0);
  std::filesystem::create_symlink("real.toml", folder.file("link.toml"));
  replace_file(folder.file("link.toml"), "new\r\n");
  CHECK(std::filesystem::is_symlink(folder.file("link.toml")));
  std::ifstream input(file, std::ios::binary);
  CHECK(std::string(std::istreambuf_iterator<char>(input), {}) == "new\r\n");
  struct stat status {};
  REQUIRE(::stat(file.c_str(), &status) == 0);
  CHECK((status.st_mode & 07777U) == 0640U);
  const std::filesystem::path parent = std::filesystem::path(file).parent_path();
  CHECK(std::distance(std::filesystem::directory_iterator(parent), {}) == 2);
  replace_file(folder.file("none.toml"), "first");
  REQUIRE(::stat(folder.file("none.toml").c_str(), &status) == 0);
  CHECK((status.st_mode & 07777U) == 0644U);
  CHECK_THROWS(replace_file(folder.file("none/none.toml"), ""));
}

TEST_CASE("what a power cut left of writing a file is no obstacle to the next time") {
  const TemporaryFolder folder;
  const std::string file = folder.file("learned.toml");
  std::ofstream(file + "." + std::to_string(::gettid())) << "old";
  replace_file(file, "new");
  std::ifstream input(file);
  CHECK(std::string(std::istreambuf_iterator<char>(input), {}) == "new");
}

}  // namespace
}  // namespace cremed
