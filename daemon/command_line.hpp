// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// The parsed command line.
struct CommandLine {
  std::string config;                       ///< Path; empty: search the default places.
  std::optional<std::string> check_config;  ///< Check this path only; empty: that of `config`.
  std::vector<std::string> replay;          ///< Logs; "-" is standard input.
  double speed = 0.0;                       ///< Log seconds per second; 0: as fast as possible.
  bool timing = false;                      ///< Measure solve_us.
  std::optional<std::string> state_file;    ///< File of the learned errors.
  std::optional<std::string> output_csv;
  std::optional<std::string> output_odometry;
  std::optional<std::string> output_tum;
  std::optional<std::string> lcm_url;
  bool publish_scans = false;  ///< Whatever output.publish_scans says.
};

/// Result of parsing: a command line, or the exit status of the process (help, version and usage
/// errors have been printed).
struct CommandLineResult {
  std::optional<CommandLine> command_line;
  int exit_status = 0;
};

CommandLineResult parse_command_line(int argc, const char* const* argv);

/// The configuration in a file, with the outputs that the command line asks for. Throws
/// ConfigurationError.
Configuration load_configuration(const std::string& path, const CommandLine& command_line);

}  // namespace cremed
