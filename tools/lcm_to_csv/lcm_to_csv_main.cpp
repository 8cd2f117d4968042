// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <system_error>

#include <CLI/CLI.hpp>

#include "daemon/plain_streams.hpp"
#include "daemon/version.hpp"
#include "tools/lcm_to_csv/lcm_to_csv.hpp"

namespace {

constexpr int kRunTimeFailure = 1;
constexpr int kBadUsage = 2;

struct Arguments {
  std::string log;
  std::string output = "-";
  std::string odometry;  // Empty: not asked for.
};

std::ostream& open(std::ofstream& file, const std::string& path) {
  if (path == "-") {
    return std::cout;
  }
  file.open(path, std::ios::binary);
  if (!file) {
    throw std::runtime_error(path + ": cannot be written");
  }
  return file;
}

void flush(std::ostream& stream, const std::string& path) {
  if (!stream.flush()) {
    throw std::runtime_error(path + ": writing failed");
  }
}

cremed::LcmLogCounters convert(const Arguments& arguments) {
  std::ofstream motion_file;
  std::ofstream odometry_file;
  std::ostream& motions = open(motion_file, arguments.output);
  if (arguments.odometry.empty()) {
    const cremed::LcmLogCounters counters = cremed::lcm_to_csv(arguments.log, motions);
    flush(motions, arguments.output);
    return counters;
  }
  std::ostream& odometries = open(odometry_file, arguments.odometry);
  const cremed::LcmLogCounters counters = cremed::lcm_to_csv(arguments.log, motions, &odometries);
  flush(motions, arguments.output);
  flush(odometries, arguments.odometry);
  return counters;
}

/// Whether the log was as it should be.
bool report(const Arguments& arguments, const cremed::LcmLogCounters& counters) {
  const std::string& log = arguments.log;
  const bool has_odometry = arguments.odometry.empty() || counters.odometries != 0;
  if (counters.bad_messages != 0) {
    std::cerr << log << ": left out " << counters.bad_messages
              << " messages that are not of this version's type of their channel\n";
  }
  if (!has_odometry) {
    std::cerr << log << ": no odometry on CREMED_ODOMETRY\n";
  }
  if (counters.ends_inside_message) {
    std::cerr << log << ": is no LCM log or ends inside a message\n";
  }
  if (counters.motions == 0) {
    std::cerr << log << ": no motion on CREMED_EGO_MOTION; record with lcm-logger\n";
  }
  return counters.bad_messages == 0 && !counters.ends_inside_message && counters.motions != 0 &&
         has_odometry;
}

int run(int argc, char** argv) {
  CLI::App app{
      "Ego-motions and odometry of an LCM log as the CSV that cremed --output-csv and\n"
      "--output-odometry write"};
  Arguments arguments;
  app.set_version_flag("--version", CREMED_VERSION);
  app.add_option("LOG", arguments.log, "Log of lcm-logger")->required();
  app.add_option("--output", arguments.output, "CSV file of the ego-motions; '-': standard output")
      ->capture_default_str();
  app.add_option("--odometry", arguments.odometry, "CSV file of the vehicle's state");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
  std::error_code not_there;
  for (const std::string& output : {arguments.output, arguments.odometry}) {
    if (std::filesystem::equivalent(arguments.log, output, not_there)) {
      std::cerr << "cremed-lcm-to-csv: " << arguments.log
                << " is to be read and written; name another file\n";
      return kBadUsage;
    }
  }
  if (arguments.output == arguments.odometry) {
    std::cerr << "cremed-lcm-to-csv: " << arguments.output << " cannot hold both outputs\n";
    return kBadUsage;
  }
  return report(arguments, convert(arguments)) ? 0 : kRunTimeFailure;
}

}  // namespace

int main(int argc, char** argv) {
  cremed::make_standard_streams_plain();
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "cremed-lcm-to-csv: " << error.what() << '\n';
    return kRunTimeFailure;
  }
}
