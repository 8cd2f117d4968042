// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "daemon/configuration/configuration.hpp"
#include "test/tools/tool_run.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

const std::string kFrontHead =
    "[[radar]]\nname = \"front\"\ntype = \"ars408\"\ninterface = \"can0\"\n";

/// A configuration with one radar; `rest` are lines of its table.
std::string write_configuration(const TemporaryFolder& folder, const std::string& name,
                                const std::string& rest) {
  std::ofstream(folder.file(name)) << kFrontHead << rest;
  return folder.file(name);
}

/// The log of a simulated drive with bends.
std::string simulate_log(const TemporaryFolder& folder, const std::string& config, int duration_s,
                         const std::string& scenario = "bends") {
  const std::string log = folder.file("drive.log");
  REQUIRE(run_tool("cremed-simulate", folder,
                   "--scenario " + scenario + " --duration " + std::to_string(duration_s) +
                       " --config " + config + " --output " + log)
              .status == 0);
  return log;
}

TEST_CASE("cremed-eval calibrate prints a table, and TOML that cremed takes") {
  const TemporaryFolder folder;
  const std::string right =
      write_configuration(folder, "right.toml", "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.1 }");
  const std::string wrong = write_configuration(
      folder, "wrong.toml",
      "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.07 }\ncalibration.doppler_std_factor = 0.5");
  const std::string log = simulate_log(folder, right, 30);
  const ToolRun result = run_tool("cremed-eval", folder, "calibrate " + log + " --config " + wrong);
  CAPTURE(result.error, result.output);
  REQUIRE(result.status == 0);
  for (const char* words :
       {"front, ", "yaw deg ", " was 4.01", "x m ", "y m ", "reference", "Doppler offset m/s ",
        "stamp offset ms ", "rotation lead ms ", "positions ahead ms ", "range std factor ",
        "azimuth scale ", "in the frame of the configured ones"}) {
    CHECK_THAT(result.error, Catch::Contains(words));
  }
  const std::string before = content(wrong);
  for (const std::string& pasted : {before + result.output, result.output + before}) {
    const RadarConfiguration found = parse_configuration(pasted, "calibrated").radars.at(0);
    CHECK(found.ego_motion.vehicle_from_radar.x_m == 3.4);
    CHECK(found.ego_motion.vehicle_from_radar.yaw_rad == Approx(0.1).margin(0.008));
    CHECK(found.ego_motion.correction.doppler_std_factor == Approx(1.0).margin(0.15));
  }
  CHECK(content(wrong) == before);
}

/// What the table says was found.
double in_table(const std::string& table, const std::string& label) {
  const std::size_t at = table.find("  " + label + " ");
  REQUIRE(at != std::string::npos);
  return std::stod(table.substr(at + label.size() + 2));
}

TEST_CASE("cremed-eval calibrate shows the numbers that the keys get") {
  const TemporaryFolder folder;
  const auto configuration = [&](const std::string& name, const std::string& calibration) {
    return write_configuration(
        folder, name,
        "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.1 }\n" + calibration +
            "[[radar]]\nname = \"left\"\ntype = \"ars408\"\ninterface = \"can1\"\n"
            "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 1.1 }\n" +
            calibration);
  };
  const std::string wrong = configuration(
      "wrong.toml",
      "calibration = { doppler_offset_mps = 0.7, rotation_lead_s = 0.1, azimuth_scale = 1.05, "
      "doppler_std_factor = 0.5, doppler_scale = 0.97 }\n");
  const std::string log = simulate_log(folder, configuration("right.toml", ""), 40);
  const ToolRun result = run_tool("cremed-eval", folder, "calibrate " + log + " --config " + wrong);
  CAPTURE(result.error, result.output);
  REQUIRE(result.status == 0);
  const Configuration found = parse_configuration(content(wrong) + result.output, "calibrated");
  const DetectionCorrection& front = found.radars.at(0).ego_motion.correction;
  CHECK(front.doppler_offset_mps != 0.7);
  CHECK(in_table(result.error, "Doppler offset m/s") ==
        Approx(front.doppler_offset_mps).margin(6e-4));
  CHECK(front.rotation_lead_s != 0.1);
  CHECK(in_table(result.error, "rotation lead ms") ==
        Approx(1e3 * front.rotation_lead_s).margin(0.06));
  CHECK(front.azimuth_scale != 1.05);
  CHECK(in_table(result.error, "azimuth scale") == Approx(front.azimuth_scale).margin(6e-5));
  CHECK(front.doppler_std_factor != 0.5);
  CHECK(in_table(result.error, "Doppler std factor") ==
        Approx(front.doppler_std_factor).margin(6e-3));
  const DetectionCorrection& left = found.radars.at(1).ego_motion.correction;
  CHECK(left.doppler_scale != 0.97);
  CHECK(in_table(result.error.substr(result.error.find("left, ")), "Doppler scale") ==
        Approx(left.doppler_scale).margin(6e-5));
}

TEST_CASE("cremed-eval calibrate --write puts the same into the configuration") {
  const TemporaryFolder folder;
  const std::string right =
      write_configuration(folder, "right.toml", "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.1 }");
  const std::string mount = "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.07 } # by tape\n";
  const std::string file = write_configuration(folder, "c.toml", mount);
  const std::string log = simulate_log(folder, right, 15);
  const ToolRun result =
      run_tool("cremed-eval", folder, "calibrate " + log + " --write --config " + file);
  CAPTURE(result.error, result.output);
  REQUIRE(result.status == 0);
  CHECK_THAT(content(file),
             Catch::StartsWith(kFrontHead + "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = "));
  CHECK_THAT(content(file), Catch::Contains(" } # by tape\n"));
  CHECK_THAT(result.error, Catch::Contains("checked on each fifth of the drive"));
  const auto yaw_rad = [](const std::string& text) {
    return parse_configuration(text, "c").radars.at(0).ego_motion.vehicle_from_radar.yaw_rad;
  };
  CHECK(yaw_rad(content(file)) == yaw_rad(kFrontHead + mount + result.output));
  CHECK(yaw_rad(content(file)) == Approx(0.1).margin(0.01));
}

TEST_CASE("cremed-eval calibrate refuses what fits the rest of the drive no better") {
  const TemporaryFolder folder;
  const std::string file =
      write_configuration(folder, "c.toml", "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.1 }");
  const std::string log = simulate_log(folder, file, 15);
  const std::string before = content(file);
  const ToolRun result =
      run_tool("cremed-eval", folder, "calibrate " + log + " --write --config " + file);
  CAPTURE(result.error, result.output);
  REQUIRE(result.status == 0);
  CHECK_THAT(result.error, Catch::Contains(": no better, so that these are kept\n"));
  CHECK_THAT(result.error,
             Catch::Contains("scans: what was found fits other parts of the drive no better\n"));
  CHECK_THAT(result.error, Catch::Contains(" kept 5.73\n"));
  CHECK_THAT(result.error, Catch::EndsWith("c.toml: unchanged\n"));
  CHECK_THAT(result.output, !Catch::Contains("[calibrated"));  // It would undo an older one.
  CHECK(content(file) == before);
}

TEST_CASE("cremed-eval calibrate finds the same yaw, however often its angle went around") {
  const TemporaryFolder folder;
  const std::string right =
      write_configuration(folder, "right.toml", "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.03 }");
  const std::string around = write_configuration(
      folder, "around.toml", "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 6.283 }");
  const std::string log = simulate_log(folder, right, 15);
  const ToolRun result =
      run_tool("cremed-eval", folder, "calibrate " + log + " --write --config " + around);
  CAPTURE(result.error, result.output);
  REQUIRE(result.status == 0);
  for (const std::string& text : {content(around), content(right) + result.output}) {
    const RadarConfiguration found = parse_configuration(text, "calibrated").radars.at(0);
    CHECK(found.ego_motion.vehicle_from_radar.yaw_rad == Approx(0.03).margin(0.01));
  }
  CHECK_THAT(result.error, !Catch::Contains(" 361."));
  CHECK_THAT(result.error, Catch::Contains("was -0.01"));
}

TEST_CASE("cremed-eval calibrate says what is wrong") {
  const auto row = GENERATE(
      Refusal{"calibrate", 2, "LOG"}, Refusal{"calibrate /dev/null", 2, "--config"},
      Refusal{"calibrate /dev/null --config /no/such.toml", 2, "/no/such.toml"},
      Refusal{"calibrate /no/such.log --config CONFIG", 1, "/no/such.log"},
      Refusal{"calibrate /dev/null --config CONFIG", 1, "no complete scan"},
      Refusal{"calibrate /dev/null --config CONFIG --truth /no/such.csv", 1, "/no/such.csv"});
  CAPTURE(row.arguments);
  const TemporaryFolder folder;
  const std::string file =
      write_configuration(folder, "c.toml", "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.1 }");
  check(run_tool("cremed-eval", folder, with_file(row.arguments, "CONFIG", file)), row);
}

TEST_CASE("cremed-eval calibrate refuses what is too far from the configuration, or stands still") {
  const TemporaryFolder folder;
  const std::string first =
      "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.0 }\n[[radar]]\nname = "
      "\"rear\"\ntype = \"ars408\"\ninterface = \"can1\"\n";
  const std::string right = write_configuration(
      folder, "right.toml", first + "mount = { x_m = -0.9, y_m = 0.0, yaw_rad = 3.1416 }");
  const std::string reversed = write_configuration(
      folder, "reversed.toml", first + "mount = { x_m = -0.9, y_m = 0.0, yaw_rad = 0.0 }");
  const auto calibrate = [&](const std::string& log, const std::string& config) {
    return run_tool("cremed-eval", folder, "calibrate " + log + " --config " + config);
  };
  const ToolRun far = calibrate(simulate_log(folder, right, 15), reversed);
  CHECK(far.status == 1);
  CHECK_THAT(far.error, Catch::Contains("rear (none of its scans fits the motion of all): ") &&
                            Catch::Contains("or that of another radar"));
  CHECK(far.output.empty());
  const std::string both = write_configuration(
      folder, "both.toml",
      "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 3.1416 }\n[[radar]]\nname = \"rear\"\ntype = "
      "\"ars408\"\ninterface = \"can1\"\nmount = { x_m = -0.9, y_m = 0.0, yaw_rad = 3.1416 }");
  const ToolRun drawn = calibrate(folder.file("drive.log"), both);  // front is wrong, not rear.
  CHECK(drawn.status == 1);
  CHECK_THAT(drawn.error, Catch::Contains("front (") || Catch::Contains("of another radar"));
  const ToolRun still = calibrate(simulate_log(folder, right, 3, "standing"), right);
  CHECK(still.status == 1);
  CHECK_THAT(still.error, Catch::Contains("the vehicle does not move"));
}

}  // namespace
