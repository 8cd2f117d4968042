// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <string>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "test/tools/tool_run.hpp"

using namespace cremed::test;
using cremed::TemporaryFolder;

namespace {

ToolRun run(const TemporaryFolder& folder, const std::string& arguments) {
  return run_tool("cremed-eval", folder, arguments);
}

/// Two pairs of three targets each that moved by 0.1 m.
std::string write_pairs(const TemporaryFolder& folder) {
  std::ofstream file(folder.file("pairs.csv"));
  for (int pair = 0; pair < 2; ++pair) {
    file << "T," << pair << ",0.1,0,0,0.1\n";
    for (int id = 0; id < 3; ++id) {
      const double azimuth_rad = 0.3 * (id - 1);
      file << "D," << pair << ",0," << id << "," << 10 + id << "," << azimuth_rad
           << ",-1,0.1,0.01,0.1\n"
           << "D," << pair << ",1," << id << "," << 9.9 + id << "," << azimuth_rad
           << ",-1,0.1,0.01,0.1\n";
    }
  }
  return folder.file("pairs.csv");
}

}  // namespace

TEST_CASE("cremed-eval table prints a row for every problem and method") {
  const TemporaryFolder folder;
  const ToolRun result = run(folder, "table --runs 2 --sets 3 --seed 5 --threads 2");
  CAPTURE(result.error);
  REQUIRE(result.status == 0);
  CHECK(result.error.empty());
  const auto rows = cells(result.output);
  CHECK(rows.size() == 22);
  for (const auto& row : rows) {
    CAPTURE(row[0], row[1]);
    REQUIRE(row.size() == 20);
    CHECK(std::stoi(row[2]) + std::stoi(row[10]) == 6);
    CHECK(std::stod(row[3]) > 0.0);
    CHECK(std::stod(row[6]) < 1.0);
    CHECK(std::stod(row[7]) > 1.0);
  }
  REQUIRE(rows[0][1] == "MSM");
  CHECK(rows[0][14] == "0.121");
}

TEST_CASE("cremed-eval prints JSON: the same figures, and no others") {
  const TemporaryFolder folder;
  const bool is_table = GENERATE(true, false);
  const std::string command = is_table ? "table --runs 1 --sets 2 --threads 1"
                                       : "pairs " + write_pairs(folder) + " --profile sim";
  const auto rows = cells(run(folder, command).output);
  const ToolRun result = run(folder, command + " --json");
  CAPTURE(command, result.error);
  REQUIRE(result.status == 0);
  const auto json = nlohmann::json::parse(result.output);
  const auto& first = is_table ? json["rows"][0] : json;
  const std::size_t cell = is_table ? 2 : 1;
  CHECK(first["method"] == rows[0][cell - 1]);
  CHECK(first["n"] == std::stoul(rows[0][cell]));
  CHECK((is_table ? first["ours"] : first)["rmse_m"].get<double>() ==
        Approx(std::stod(rows[0][cell + 1])).margin(1e-3));
}

TEST_CASE("cremed-eval draws what it measured") {
  const TemporaryFolder folder;
  const auto command = GENERATE(std::string("table"), std::string("pairs"));
  const std::string arguments =
      command == "table" ? "--runs 1 --sets 2" : write_pairs(folder) + " --profile sim";
  CAPTURE(command);
  const std::string picture = folder.file("picture.svg");
  const ToolRun result = run(folder, command + " " + arguments + " --plot " + picture);
  CAPTURE(result.error);
  CHECK(result.status == 0);
  CHECK(content(picture).find("</svg>") != std::string::npos);
}

TEST_CASE("cremed-eval pairs registers by each of the methods") {
  const TemporaryFolder folder;
  const std::string pairs = write_pairs(folder);
  const auto method = GENERATE(std::string("msm"), std::string("sa"), std::string("icp"));
  const ToolRun result = run(folder, "pairs " + pairs + " --profile sim --method " + method);
  CAPTURE(method, result.error);
  REQUIRE(result.status == 0);
  const auto rows = cells(result.output);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0][0] == method);
  CHECK(rows[0][1] == "2");
  CHECK(std::stod(rows[0][2]) < 0.05);
}

TEST_CASE("cremed-eval says what is wrong") {
  const auto row = GENERATE(
      Refusal{"table --runs 0", 2, "--runs"}, Refusal{"table --sets -1", 2, "--sets"},
      Refusal{"table --threads 0", 2, "--threads"}, Refusal{"table --seed x", 2, "--seed"},
      Refusal{"pairs /dev/null --profile sim --method other", 2, "--method"},
      Refusal{"pairs /no/such/file --profile sim", 1, "/no/such/file"},
      Refusal{"pairs PAIRS --profile sim --output /no/such/folder/a.csv", 1, "cannot write"},
      Refusal{"pairs PAIRS --profile sim --plot /no/such/folder/a.png", 1, "cannot write"});
  CAPTURE(row.arguments);
  const TemporaryFolder folder;
  check(run(folder, with_file(row.arguments, "PAIRS", write_pairs(folder))), row);
}

TEST_CASE("cremed-eval pairs hands no name's commands on to the terminal") {
  const TemporaryFolder folder;
  const ToolRun result = run(folder, "pairs 'e\x1B]0;x\x07' --profile sim");
  CHECK(result.status != 0);
  CHECK_THAT(result.error, Catch::Contains("e?]0;x?") && !Catch::Contains("\x1B"));
}
