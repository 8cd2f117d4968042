// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <catch2/catch.hpp>

#include "daemon/process/plain_text.hpp"
#include "test/tools/tool_run.hpp"

using namespace cremed;
using namespace cremed::test;

TEST_CASE("No program hands a name's commands on to the terminal") {
  struct Row {
    std::string program;
    std::string arguments;
  };
  const std::string config = "--config " CREMED_SOURCE_DIR "/test/data/bends.toml ";
  const auto row = GENERATE_COPY(
      Row{"cremed", "--config EVIL"}, Row{"cremed", "--check-config EVIL"},
      Row{"cremed", config + "--replay EVIL"}, Row{"cremed", "--EVIL"},
      Row{"cremed-doctor", config + "--replay EVIL"}, Row{"cremed-eval", "drive EVIL EVIL"},
      Row{"cremed-eval", "calibrate EVIL " + config}, Row{"cremed-lcm-to-csv", "EVIL"},
      Row{"cremed-simulate", "--scenario EVIL --output -"},
      Row{"cremed-simulate", "--scenario bends --output /nowhere/EVIL"});
  CAPTURE(row.program, row.arguments);
  const std::string evil = "e\x1B]0;x\x07\x9B\xC2\x9B\x7F";
  std::string arguments = row.arguments;
  for (std::size_t at = arguments.find("EVIL"); at != std::string::npos;
       at = arguments.find("EVIL")) {
    arguments.replace(at, 4, "'" + evil + "'");
  }
  const TemporaryFolder folder;
  const ToolRun result = run_tool(row.program, folder, arguments);
  const std::string all = result.output + result.error;
  CHECK(result.status != 0);
  CHECK(plain_text(all) == all);
  CHECK_THAT(all, Catch::Contains("e?]0;x?"));
}
