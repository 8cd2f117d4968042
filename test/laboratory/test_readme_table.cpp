// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "test/tools/readme_rows.hpp"
#include "test/tools/tool_run.hpp"
#include "tools/laboratory/table/drive_figures.hpp"
#include "tools/laboratory/table/drive_table.hpp"
#include "tools/laboratory/unpacked_file.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

const ReadmeTable kTable{"times", {"drive", "after 1 s"}, {{"a b", "0.12, 3"}, {"c", "–"}}};

const std::string kMarkdown =
    "<!-- cremed-eval table --drives: times -->\n"
    "| drive | after 1 s |\n|---|---|\n| a b | 0.12, 3 |\n| c | – |\n";

}  // namespace

TEST_CASE("A table is written below its comment and read again") {
  CHECK(to_markdown(kTable) == kMarkdown);
  const auto rows = rows_in("text\n" + kMarkdown + "\n| other |\n", "times");
  REQUIRE(rows);
  CHECK(*rows == kTable.rows);
  CHECK_FALSE(rows_in(kMarkdown, "time"));
}

TEST_CASE("A README keeps all but the table of that name") {
  const std::string other = "<!-- cremed-eval table --drives: methods -->\n| x |\n|---|\n| y |\n";
  const std::string old =
      "<!-- cremed-eval table --drives: times -->\n| old |\n|---|\n| 7 |\n| 8 |\n";
  CHECK(with_table("before\n\n" + old + "after\n\n" + other, kTable) ==
        "before\n\n" + kMarkdown + "after\n\n" + other);
  CHECK(with_table("before\n" + old, kTable) == "before\n" + kMarkdown);
  CHECK(with_table(other, kTable) == other);
}

TEST_CASE("A mean is of the figures that all drives have") {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto mean = mean_figures({{{"10 s", {1.0, 4.0}}, {"30 s", {unknown}}, {"front", {1.0}}},
                                  {{"10 s", {3.0, 0.0}}, {"30 s", {2.0}}}});
  CHECK(mean.size() == 2);
  CHECK(mean.at("10 s") == std::vector<double>{2.0, 2.0});
  CHECK(std::isnan(mean.at("30 s")[0]));
  CHECK(mean_figures({}).empty());
}

TEST_CASE("A file is found packed or not") {
  const TemporaryFolder folder;
  const TemporaryFolder unpacked;
  const std::string path = folder.file("can.log");
  CHECK(unpacked_file(path, unpacked) == path);
  std::ofstream(path) << "frames\n";
  CHECK(unpacked_file(path, unpacked) == path);
  REQUIRE(std::system(("xz " + path).c_str()) == 0);
  CHECK(content(unpacked_file(path, unpacked)) == "frames\n");
  std::ofstream(path + ".xz") << "not packed";
  CHECK_THROWS_WITH(unpacked_file(path, unpacked), Catch::Contains("can.log.xz with xz"));
}

TEST_CASE("cremed-eval table --drives says what is missing") {
  const TemporaryFolder folder;
  check(run_tool("cremed-eval", folder, "table --drives " + folder.file("")),
        {"", 2, "scene-0061/truth.csv; FOLDER must hold the recorded drives"});
  check(run_tool("cremed-eval", folder, "table --write"), {"", 2, "--write requires --drives"});
  check(run_tool("cremed-eval", folder, "table --drives x --real y"), {"", 2, "excludes"});
}
