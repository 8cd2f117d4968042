// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <fstream>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#include "daemon/process/file_aliases.hpp"
#include "tools/lcm_to_csv/lcm_to_csv.hpp"
#include "tools/line_file.hpp"
#include "tools/program.hpp"

namespace {

struct Arguments {
  std::string log;
  std::string output = "-";
  std::string odometry;  // Empty: none.
};

cremed::LcmLogCounters convert(const Arguments& arguments) {
  if (!std::ifstream(arguments.log)) {  // Checked before an output is truncated.
    throw std::runtime_error("cannot read " + arguments.log);
  }
  cremed::LineFile motions(arguments.output);
  std::optional<cremed::LineFile> odometries;
  if (!arguments.odometry.empty()) {
    odometries.emplace(arguments.odometry);
  }
  cremed::LcmLogCounters counters =
      cremed::lcm_to_csv(arguments.log, motions, odometries ? &*odometries : nullptr);
  motions.finish();
  if (odometries) {
    odometries->finish();
  }
  return counters;
}

/// Whether the log had no faults.
bool report(const Arguments& arguments, const cremed::LcmLogCounters& counters) {
  const std::string& log = arguments.log;
  const bool has_odometry = arguments.odometry.empty() || counters.odometries != 0;
  if (counters.bad_messages != 0) {
    std::cerr << log << ": ignored " << counters.bad_messages
              << " messages of another type than their channel's in this version\n";
  }
  if (!has_odometry) {
    std::cerr << log << ": no odometry on CREMED_ODOMETRY\n";
  }
  if (!counters.damage.empty()) {
    std::cerr << counters.damage
              << (counters.motions != 0 ? "; what comes before is converted\n" : "\n");
  } else if (counters.motions == 0) {
    std::cerr << log << ": no motion on CREMED_EGO_MOTION; record with lcm-logger\n";
  }
  return counters.bad_messages == 0 && counters.damage.empty() && counters.motions != 0 &&
         has_odometry;
}

int run(CLI::App& app, int argc, char** argv) {
  app.footer(
      "Examples:\n"
      "  Both tables of what lcm-logger recorded.\n"
      "    $ cremed-lcm-to-csv heard.lcm --output motions.csv --odometry state.csv");
  Arguments arguments;
  app.add_option("LOG", arguments.log, "Log of lcm-logger")->type_name("FILE")->required();
  app.add_option("--output", arguments.output, "CSV file of the ego-motions; '-': standard output")
      ->type_name("FILE")
      ->capture_default_str();
  app.add_option("--odometry", arguments.odometry, "CSV file of the vehicle's state")
      ->type_name("FILE");
  app.parse(argc, argv);
  cremed::refuse_aliases({{"LOG", arguments.log}},
                         {{"--output", arguments.output}, {"--odometry", arguments.odometry}});
  return report(arguments, convert(arguments)) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return cremed::run_program(
      "cremed-lcm-to-csv",
      "Writes an LCM log as CSV\n"
      "Ego-motions and odometry become the rows that cremed --output-csv and --output-odometry "
      "write.",
      run, argc, argv);
}
