// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "test/tools/tool_run.hpp"
#include "tools/laboratory/figures_json.hpp"
#include "tools/laboratory/table/drive_pairs.hpp"
#include "tools/laboratory/table/real_table.hpp"
#include "tools/laboratory/table/robot_drive.hpp"
#include "tools/laboratory/table/table_report.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

const std::string kArs408 =
    "[[radar]]\nname = \"side\"\ntype = \"bosch_gpr\"\ninterface = \"can1\"\n"
    "mount = { x_m = 2.0, y_m = 0.8, yaw_rad = 1.57 }\n"
    "[[radar]]\nname = \"front\"\ntype = \"ars408\"\ninterface = \"can0\"\n"
    "mount = { x_m = 3.4, y_m = 0.0, yaw_rad = 0.0 }\n";

/// A simulated drive in the form that cremed-convert writes.
void write_drive(const TemporaryFolder& folder, const std::string& name, int seed) {
  const std::filesystem::path drive = folder.file("drives/" + name);
  create_directories(drive);
  std::ofstream(drive / "cremed.toml") << kArs408;
  const ToolRun run =
      run_tool("cremed-simulate", folder,
               "--scenario bends --duration 6 --seed " + std::to_string(seed) + " --config " +
                   (drive / "cremed.toml").string() + " --output " + (drive / "can.log").string() +
                   " --truth " + (drive / "truth.csv").string());
  CAPTURE(run.error);
  REQUIRE(run.status == 0);
}

RealTableOptions options_of(const TemporaryFolder& folder) {
  return {.folder = folder.file("drives"), .seed = 1, .threads = 2, .truth_noise = {}};
}

std::string printed(const RealTable& table) {
  std::array<char, 8192> text{};
  std::FILE* stream = ::fmemopen(text.data(), text.size() - 1, "w");
  print_real_table(stream, table);
  std::fclose(stream);
  return text.data();
}

}  // namespace

TEST_CASE("The table of real drives has the paper's figures and ours, and those of a robot") {
  const TemporaryFolder folder;
  write_drive(folder, "scene-0001", 1);
  write_drive(folder, "scene-0002", 2);
  std::ofstream(folder.file("drives/notes.txt")) << "no drive\n";
  const RealTable table = real_table(options_of(folder));
  CHECK(table.drives == 2);
  REQUIRE(table.rows.size() == 6);
  const RealRow& positions = table.rows[0];
  CHECK(positions.problem == "NuSc");
  CHECK(positions.paper.rmse_m == 0.163);
  CHECK(positions.paper_850.anees == 1.63);
  CHECK(table.rows[1].paper.rmse_deg == 0.105);
  CHECK(table.rows[2].method == "cremed");
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    CHECK(table.rows[i].credibility.count() >= 150);  // Of 6 s of two ARS408, 13.7 scans a second.
    CHECK(table.rows[i].credibility.count() <= 166);
    CHECK(std::isnan(table.rows[3 + i].paper_850.rmse_m));
    CHECK(table.rows[3 + i].problem == "Robot");
  }
  CHECK(positions.credibility.rmse_m() > 0.05);
  CHECK(table.rows[1].credibility.rmse_m() < 0.02);
  CHECK(table.rows[2].credibility.rmse_m() < 0.02);
  CHECK(table.rows[2].credibility.anees() < 2.0);
  CHECK(table.rows[3].paper.anees == 2.53);
  CHECK(table.rows[4].paper.rmse_m == 0.0110);
  CHECK(table.rows[5].credibility.anees() > 0.8);
  CHECK(table.rows[5].credibility.anees() < 1.25);
  REQUIRE(table.odometry.size() == 4);
  CHECK(table.odometry[0].errors.segments > 0);
  CHECK(table.odometry[3].errors.length.time_s == 10.0);
  CHECK(table.odometry[3].errors.position_percent < 5.0);

  const std::string text = printed(table);
  CHECK_THAT(text, Catch::Contains("2 drives in the folder"));
  CHECK_THAT(text, Catch::Contains("Robot: SIMULATED"));
  CHECK_THAT(text, Catch::Contains("| 0.0116  0.105  3.360 | 0.0122  0.096  4.490\n"));
  CHECK_THAT(text, Catch::Contains("Robot     after 10 s "));
  const auto json = nlohmann::json::parse(real_table_json(table));
  CHECK(json["rows"].size() == 6);
  CHECK(json["rows"][2]["ours"]["anees"] == Approx(table.rows[2].credibility.anees()));
  CHECK(json["rows"][4]["is_simulated"] == true);
  CHECK(json["rows"][4]["paper_trainval"]["rmse_m"].is_null());
  CHECK(json["odometry"][1]["time_s"] == 10.0);
}

TEST_CASE("Truth's own noise widens the covariances of the drives") {
  const TemporaryFolder folder;
  write_drive(folder, "one", 1);
  const std::string one = folder.file("drives/one/");
  const auto nees = [&](const TruthNoise& noise) {
    const DrivePairs pairs = pair_drive(
        {one + "can.log", one + "truth.csv", load_configuration(one + "cremed.toml"), noise},
        "nuscenes");
    const PairedMotion& motion = pairs.own.motions.at(40);
    return std::pair(motion.covariance(0, 0), pairs.paper.motions.at(40).covariance(2, 2));
  };
  const auto without = nees({});
  const auto with = nees(TruthNoise({{.x_m = 0.5, .y_m = 0.5, .yaw_rad = 0.25}}));
  CHECK(with.first - without.first == Approx(0.25));
  CHECK(with.second - without.second == Approx(0.0625));
}

TEST_CASE("The evaluated radar is that named front, otherwise the first") {
  const TemporaryFolder folder;
  std::ofstream(folder.file("a.toml")) << kArs408;
  CHECK(paired_radar(load_configuration(folder.file("a.toml"))) == 1);
  CHECK(paired_radar(robot_drive(1, folder).configuration) == 0);
}

TEST_CASE("A folder without drives, or with a broken one, is named") {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& options) {
    return run_tool("cremed-eval", folder, "table --real " + options);
  };
  CHECK(run(folder.file("none")).status == 2);
  CHECK_THAT(run(folder.file("none")).error,
             Catch::Contains("has no folder with can.log, truth.csv and cremed.toml; must be "
                             "the --output of `cremed-convert nuscenes`"));
  CHECK_THAT(run("x --runs 3").error, Catch::Contains("--real excludes --runs"));
  CHECK_THAT(run_tool("cremed-eval", folder, "table --truth-std 0.1,0.1").error,
             Catch::Contains("--truth-std requires --real"));
  write_drive(folder, "one", 1);
  std::ofstream(folder.file("drives/one/can.log")) << "";
  const ToolRun empty = run(folder.file("drives"));
  CHECK(empty.status == 1);
  CHECK_THAT(empty.error, Catch::Contains("one/can.log: no estimate within the time of "));
  std::ofstream(folder.file("drives/one/cremed.toml")) << "radar = 1\n";
  CHECK(run(folder.file("drives")).status == 2);
}

TEST_CASE("The campus is a walk with tight turns among few targets") {
  const TemporaryFolder folder;
  const DrivePairs pairs = pair_drive(robot_drive(1, folder), "robot");
  CHECK(pairs.own.motions.size() > 1150);  // 120 s at 10 Hz.
  CHECK(pairs.own.left_out <= 5);
  double way_m = 0.0;
  double fastest_turn_rad = 0.0;
  for (const PairedMotion& motion : pairs.own.motions) {
    way_m += motion.truth.head<2>().norm();
    fastest_turn_rad = std::max(fastest_turn_rad, std::abs(motion.truth.z()));
  }
  CHECK(way_m / 120.0 > 0.7);
  CHECK(way_m / 120.0 < 1.2);
  CHECK(fastest_turn_rad > 0.06);  // 0.6 rad/s
}
