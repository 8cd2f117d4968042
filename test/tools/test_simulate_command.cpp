// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <catch2/catch.hpp>
#include <sys/wait.h>

#include "test/tools/simulated_drive.hpp"

namespace {

namespace fs = std::filesystem;

/// An empty folder of this process, removed at the end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("cremed-simulate-" + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }

  [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

struct Result {
  int status;
  std::string output;
  std::string error;
};

Result run(const Folder& folder, const std::string& arguments) {
  const std::string command = std::string(CREMED_BINARY_DIR) + "/bin/cremed-simulate " + arguments +
                              " >" + folder.file("stdout") + " 2>" + folder.file("stderr");
  const int status = std::system(command.c_str());
  return {WEXITSTATUS(status), content(folder.file("stdout")), content(folder.file("stderr"))};
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
  CHECK(first.log == again.log);
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
  CHECK(cremed::test::drive(city, radars, options).log != first.log);
}

TEST_CASE("cremed-simulate writes log and truth") {
  const Folder folder;
  const std::string log = folder.file("drive.log");
  const std::string truth = folder.file("truth.csv");
  const Result result = run(folder, "--scenario bends --duration 3 --seed 9 --start 1600000000" +
                                        (" --output " + log) + " --truth " + truth);
  CHECK(result.status == 0);
  CHECK(result.error.empty());
  CHECK(content(log).rfind("(16000000", 0) == 0);
  CHECK(content(truth).rfind("utime,x_m,y_m,yaw_rad\n1600000000000000,", 0) == 0);

  const Result piped = run(folder,
                           "--scenario bends --duration 3 --seed 9 --start 1600000000 "
                           "--output -");
  CHECK(piped.status == 0);
  CHECK(piped.output == content(log));
}

TEST_CASE("cremed-simulate names its scenarios") {
  const Folder folder;
  const Result result = run(folder, "--scenario list");
  CHECK(result.status == 0);
  for (const auto& scenario : cremed::scenarios()) {
    CHECK(result.output.find(std::string(scenario.name) + " ") != std::string::npos);
    CHECK(result.output.find(std::string(scenario.description)) != std::string::npos);
  }
}

TEST_CASE("cremed-simulate takes its radars from the daemon's configuration") {
  const Folder folder;
  std::ofstream(folder.file("radars.toml")) << R"(
[[radar]]
name = "left"
type = "ars408"
interface = "can7"
sensor_id = 2
mount = { x_m = 2.0, y_m = 0.9, yaw_rad = 1.5 }
)";
  const Result result = run(
      folder, "--scenario standing --duration 2 --output - --config " + folder.file("radars.toml"));
  CAPTURE(result.error);
  CHECK(result.status == 0);
  CHECK(result.output.find(" can7 620#") != std::string::npos);
  CHECK(result.output.find(" can0 ") == std::string::npos);
}

TEST_CASE("without a configuration the radars are those of the demo") {
  const std::string path = std::string(CREMED_SOURCE_DIR) + "/config/demo.toml";
  const auto expected = cremed::load_configuration(path).radars;
  const auto radars = cremed::default_radars();
  REQUIRE(radars.size() == expected.size());
  for (std::size_t i = 0; i < radars.size(); ++i) {
    const cremed::Pose2& mount = radars[i].ego_motion.vehicle_from_radar;
    const cremed::Pose2& expected_mount = expected[i].ego_motion.vehicle_from_radar;
    CHECK(radars[i].name == expected[i].name);
    CHECK(radars[i].interface == expected[i].interface);
    CHECK(radars[i].decoder.index() == expected[i].decoder.index());
    CHECK(mount.x_m == expected_mount.x_m);
    CHECK(mount.y_m == expected_mount.y_m);
    CHECK(mount.yaw_rad == expected_mount.yaw_rad);
  }
}

TEST_CASE("cremed-simulate says what is wrong") {
  struct Row {
    std::string arguments;
    int status;
    std::string message;
  };
  const auto row = GENERATE(
      Row{"", 2, "--scenario"}, Row{"--scenario nowhere --output -", 2, "--scenario list"},
      Row{"--scenario city", 2, "--output is required"},
      Row{"--scenario city --output - --speed 3", 2, "--speed"},
      Row{"--scenario city --output - --duration -1", 2, "--duration"},
      Row{"--scenario city --output - --duration 1 --config /no/such/file.toml", 2,
          "/no/such/file.toml"},
      Row{"--scenario city --duration 1 --output /no/such/folder/log", 1, "cannot be written"},
      Row{"--scenario city --duration 1 --output - --truth /no/such/folder/t", 1,
          "cannot be written"},
      Row{"--scenario city --duration 1 --output /dev/full", 1, "writing failed"});
  CAPTURE(row.arguments);
  const Folder folder;
  const Result result = run(folder, row.arguments);
  CAPTURE(result.error);
  CHECK(result.status == row.status);
  CHECK(result.error.find(row.message) != std::string::npos);
}
