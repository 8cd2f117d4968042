// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <string>

#include <catch2/catch.hpp>

#include "daemon/process/file_aliases.hpp"
#include "daemon/process/usage_error.hpp"
#include "test/daemon/temporary_file.hpp"

namespace cremed {
namespace {

namespace fs = std::filesystem;

TEST_CASE("An output is refused that is an input, by whatever path") {
  const TemporaryFile log("frames");
  const std::string link = log.path() + ".link";
  const std::string hard_link = log.path() + ".hard";
  fs::create_symlink(log.path(), link);
  fs::create_hard_link(log.path(), hard_link);
  for (const std::string& path : {log.path(), "/tmp/../" + log.path(), link, hard_link}) {
    CHECK_THROWS_WITH(refuse_aliases({{"the log", log.path()}}, {{"--output-csv", path}}),
                      Catch::Contains("--output-csv would overwrite the log, " + path));
  }
  CHECK(log.content() == "frames");
  fs::remove(link);
  fs::remove(hard_link);
}

TEST_CASE("A log that is given twice is refused: its frames would count twice") {
  const TemporaryFile log("frames");
  const TemporaryFile same_content("frames");
  CHECK_THROWS_WITH(
      refuse_aliases({{"the log", log.path()}, {"the log", "/tmp/../" + log.path()}}, {}),
      Catch::Contains(log.path() + " is given twice"));
  CHECK_NOTHROW(refuse_aliases({{"the log", log.path()}, {"the log", same_content.path()}}, {}));
  CHECK_NOTHROW(refuse_aliases({{"TRUTH", log.path()}, {"--wheels", log.path()}}, {}));
}

TEST_CASE("Two outputs are refused that will be one file, which is not there yet") {
  const TemporaryFile file;
  const std::string absent = file.path() + ".new";
  const std::string dangling = file.path() + ".link";
  fs::create_symlink(fs::path(absent).filename(), dangling);
  for (const std::string& path : {absent, "/tmp/../" + absent, dangling}) {
    CHECK_THROWS_WITH(refuse_aliases({}, {{"--output-csv", absent}, {"--output-tum", path}}),
                      Catch::Contains("--output-csv and --output-tum are one file"));
  }
  CHECK_FALSE(fs::exists(absent));
  fs::remove(dangling);
}

TEST_CASE("Devices are anybody's, and what is not asked for is no file") {
  CHECK_NOTHROW(refuse_aliases({{"the log", "/dev/null"}},
                               {{"a", "/dev/null"}, {"b", "/dev/null"}, {"c", ""}, {"d", ""}}));
  CHECK_NOTHROW(refuse_aliases({{"the log", "-"}}, {{"a", "-"}}));  // Two streams.
  CHECK_THROWS_AS(refuse_aliases({}, {{"a", "-"}, {"b", "-"}}), UsageError);
}

TEST_CASE("The file of an LCM address") {
  CHECK(lcm_file("file:///tmp/a.lcm?mode=w") == "/tmp/a.lcm");
  CHECK(lcm_file("file://a.lcm") == "a.lcm");
  CHECK(lcm_file("udpm://239.255.76.67:7667?ttl=0").empty());
  CHECK(lcm_file("none").empty());
}

}  // namespace
}  // namespace cremed
