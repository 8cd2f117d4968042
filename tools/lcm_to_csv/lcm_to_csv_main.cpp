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

#include "daemon/version.hpp"
#include "tools/lcm_to_csv/lcm_to_csv.hpp"

namespace {

constexpr int kRunTimeFailure = 1;
constexpr int kBadUsage = 2;

cremed::LcmLogCounters convert(const std::string& log, const std::string& output) {
  std::ofstream file;
  if (output != "-") {
    file.open(output, std::ios::binary);
  }
  std::ostream& csv = output == "-" ? std::cout : file;
  if (!csv) {
    throw std::runtime_error(output + ": cannot be written");
  }
  const cremed::LcmLogCounters counters = cremed::lcm_to_csv(log, csv);
  if (!csv.flush()) {
    throw std::runtime_error(output + ": writing failed");
  }
  return counters;
}

/// Whether the log was as it should be.
bool report(const std::string& log, const cremed::LcmLogCounters& counters) {
  if (counters.bad_messages != 0) {
    std::cerr << log << ": left out " << counters.bad_messages
              << " messages on CREMED_EGO_MOTION that are no cremed.ego_motion_t of this version\n";
  }
  if (counters.ends_inside_message) {
    std::cerr << log << ": is no LCM log or ends inside a message\n";
  }
  if (counters.motions == 0) {
    std::cerr << log << ": no motion on CREMED_EGO_MOTION; record with lcm-logger\n";
  }
  return counters.bad_messages == 0 && !counters.ends_inside_message && counters.motions != 0;
}

int run(int argc, char** argv) {
  CLI::App app{"Odometry of an LCM log as the CSV that cremed --output-csv writes"};
  std::string log;
  std::string output = "-";
  app.set_version_flag("--version", CREMED_VERSION);
  app.add_option("LOG", log, "Log of lcm-logger")->required();
  app.add_option("--output", output, "CSV file; '-': standard output")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kBadUsage;
  }
  std::error_code not_there;
  if (std::filesystem::equivalent(log, output, not_there)) {
    std::cerr << "cremed-lcm-to-csv: " << log << " is to be read and written; name another file\n";
    return kBadUsage;
  }
  return report(log, convert(log, output)) ? 0 : kRunTimeFailure;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "cremed-lcm-to-csv: " << error.what() << '\n';
    return kRunTimeFailure;
  }
}
