// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <string>

#include <catch2/catch.hpp>

#include "test/tools/simulated_drive.hpp"
#include "test/tools/tool_run.hpp"

using namespace cremed::test;
using cremed::TemporaryFolder;

namespace {

ToolRun run_simulate(const TemporaryFolder& folder, const std::string& arguments) {
  return run_tool("cremed-simulate", folder, arguments);
}

}  // namespace

TEST_CASE("a seed decides every byte, and another radar changes none of the first one's") {
  const auto& city = cremed::test::scenario("city");
  cremed::SimulationOptions options;
  options.duration_s = 10.0;
  options.seed = 5;
  const auto radars = cremed::default_radars();
  const auto first = cremed::test::drive(city, radars, options);
  const auto again = cremed::test::drive(city, radars, options);
  CHECK(first.log() == again.log());
  CHECK(first.truth_csv == again.truth_csv);

  const auto alone = cremed::test::drive(city, {radars[0]}, options);
  std::size_t index = 0;
  for (const auto& frame : first.frames) {
    if (frame.interface != 0) continue;
    const auto& other = alone.frames.at(index++);
    REQUIRE(frame.stamp_us == other.stamp_us);
    REQUIRE(frame.id == other.id);
    REQUIRE(frame.data == other.data);
  }
  CHECK(index == alone.frames.size());

  options.seed = 6;
  CHECK(cremed::test::drive(city, radars, options).log() != first.log());
}

TEST_CASE("cremed-simulate writes log and truth") {
  const TemporaryFolder folder;
  const std::string log = folder.file("drive.log");
  const std::string truth = folder.file("truth.csv");
  const ToolRun result =
      run_simulate(folder, "--scenario bends --duration 3 --seed 9 --start 1600000000" +
                               (" --output " + log) + " --truth " + truth);
  CHECK(result.status == 0);
  CHECK(result.error.empty());
  CHECK(content(log).rfind("(16000000", 0) == 0);
  CHECK(content(truth).rfind("utime,x_m,y_m,yaw_rad\n1600000000000000,", 0) == 0);

  const ToolRun piped = run_simulate(folder,
                                     "--scenario bends --duration 3 --seed 9 --start 1600000000 "
                                     "--output -");
  CHECK(piped.status == 0);
  CHECK(piped.output == content(log));
}

TEST_CASE("cremed-simulate names its scenarios") {
  const TemporaryFolder folder;
  const ToolRun result = run_simulate(folder, "--scenario list");
  CHECK(result.status == 0);
  for (const auto& scenario : cremed::scenarios()) {
    CHECK(result.output.find(std::string(scenario.name) + " ") != std::string::npos);
    CHECK(result.output.find(std::string(scenario.description)) != std::string::npos);
  }
}

TEST_CASE("ARS408s that are not told the motion say so in 0x201") {
  const TemporaryFolder folder;
  CHECK(run_simulate(folder, "--help").output.find("  --not-told  ") != std::string::npos);
  const auto log = [&](const std::string& more) {
    return run_simulate(folder, "--scenario bends --duration 1 --output - " + more).output;
  };
  CHECK(log("").find("can0 201#4019000010180000") != std::string::npos);
  CHECK(log("--not-told").find("can0 201#4019000010D80000") != std::string::npos);
}

TEST_CASE("cremed-simulate takes its radars from the daemon's configuration") {
  const TemporaryFolder folder;
  std::ofstream(folder.file("radars.toml")) << R"(
[[radar]]
name = "left"
type = "ars408"
interface = "can7"
sensor_id = 2
mount = { x_m = 2.0, y_m = 0.9, yaw_rad = 1.5 }
)";
  const ToolRun result = run_simulate(
      folder, "--scenario standing --duration 2 --output - --config " + folder.file("radars.toml"));
  CAPTURE(result.error);
  CHECK(result.status == 0);
  CHECK(result.output.find(" can7 620#") != std::string::npos);
  CHECK(result.output.find(" can0 ") == std::string::npos);
}

TEST_CASE("without a configuration the radars are those of the demo") {
  const std::string path = CREMED_SOURCE_DIR "/config/demo.toml";
  const auto expected = cremed::load_configuration(path).radars;
  const auto radars = cremed::default_radars();
  REQUIRE(radars.size() == expected.size());
  for (std::size_t i = 0; i < radars.size(); ++i) {
    const cremed::Pose2& mount = radars[i].ego_motion.vehicle_from_radar;
    const cremed::Pose2& expected_mount = expected[i].ego_motion.vehicle_from_radar;
    CHECK(radars[i].name == expected[i].name);
    CHECK(radars[i].interface == expected[i].interface);
    CHECK(radars[i].decoder.is_same_radar(expected[i].decoder));
    CHECK(mount.x_m == expected_mount.x_m);
    CHECK(mount.y_m == expected_mount.y_m);
    CHECK(mount.yaw_rad == expected_mount.yaw_rad);
    CHECK(radars[i].ego_motion.correction.rotation_lead_s ==
          expected[i].ego_motion.correction.rotation_lead_s);
    CHECK(radars[i].ego_motion.correction.azimuth_scale ==
          expected[i].ego_motion.correction.azimuth_scale);
  }
}

TEST_CASE("cremed-simulate says what is wrong") {
  const auto row = GENERATE(
      Refusal{"", 2, "--scenario"}, Refusal{"--scenario nowhere --output -", 2, "--scenario list"},
      Refusal{"--scenario city", 2, "--output is required"},
      Refusal{"--scenario city --output - --speed 3", 2, "--speed"},
      Refusal{"--scenario city --output - --duration -1", 2, "--duration"},
      Refusal{"--scenario city --output - --duration nan", 2, "--duration: Value nan is not"},
      Refusal{"--scenario city --output - --duration 1 --config /no/such/file.toml", 2,
              "/no/such/file.toml"},
      Refusal{"--scenario city --duration 1 --output /no/such/folder/log", 1, "cannot write"},
      Refusal{"--scenario city --duration 1 --output - --truth /no/such/folder/t", 1,
              "cannot write"},
      Refusal{"--scenario city --duration 1 --output /dev/full", 1,
              "line 1 could not be written: No space left"});
  CAPTURE(row.arguments);
  const TemporaryFolder folder;
  check(run_simulate(folder, row.arguments), row);
}
