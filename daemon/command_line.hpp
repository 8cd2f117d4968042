// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace cremed {

/// What the user asked for.
struct CommandLine {
  std::string config;                       ///< Path; empty: the default places.
  std::optional<std::string> check_config;  ///< Path to check only; empty: the default places.
  std::vector<std::string> replay;          ///< Logs; "-" is standard input.
  double speed = 0.0;                       ///< Log seconds per second; 0: as fast as possible.
  bool timing = false;                      ///< Measure solve_us.
  std::optional<std::string> state_file;    ///< Of what was learned.
  std::optional<std::string> output_csv;
  std::optional<std::string> output_odometry;
  std::optional<std::string> output_tum;
  std::optional<std::string> lcm_url;
};

/// How parsing ended: with a command line, or with the process's exit status (help, version and bad
/// usage have then been printed).
struct CommandLineResult {
  std::optional<CommandLine> command_line;
  int exit_status = 0;
};

CommandLineResult parse_command_line(int argc, const char* const* argv);

}  // namespace cremed
