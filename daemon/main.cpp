// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "daemon/command_line.hpp"
#include "daemon/configuration.hpp"
#include "daemon/configuration_path.hpp"
#include "daemon/configuration_summary.hpp"
#include "daemon/run_live.hpp"
#include "daemon/run_replay.hpp"

namespace {

enum ExitStatus : int { good = 0, failure = 1, bad_usage = 2 };

void warn_of_doubts(const cremed::Configuration& configuration) {
  for (const std::string& doubt : cremed::configuration_doubts(configuration)) {
    spdlog::warn("{}", doubt);
  }
}

int check_configuration(const std::string& path) {
  const auto configuration = cremed::load_configuration(path);
  std::fputs(cremed::configuration_summary(configuration).c_str(), stdout);
  warn_of_doubts(configuration);
  spdlog::info("{}: good, number of radars: {}", path, configuration.radars.size());
  return good;
}

int run(const cremed::CommandLine& command_line) {
  if (!command_line.check_config.empty()) {
    return check_configuration(command_line.check_config);
  }
  const std::string path = cremed::configuration_path(command_line.config);
  const auto configuration = cremed::load_configuration(path);
  spdlog::set_level(spdlog::level::from_str(configuration.logging.level));
  spdlog::info("configuration: {}", path);
  warn_of_doubts(configuration);
  return command_line.replay.empty() ? cremed::run_live(command_line, path, configuration)
                                     : cremed::run_replay(command_line, configuration);
}

}  // namespace

int main(int argc, char** argv) {
  spdlog::set_default_logger(spdlog::stderr_color_st("cremed"));
  spdlog::set_pattern("%^%l%$: %v");
  const cremed::CommandLineResult result = cremed::parse_command_line(argc, argv);
  if (!result.command_line) {
    return result.exit_status;
  }
  try {
    return run(*result.command_line);
  } catch (const cremed::ConfigurationError& error) {
    spdlog::error("{}", error.what());
    return bad_usage;
  } catch (const cremed::UsageError& error) {
    spdlog::error("{}", error.what());
    return bad_usage;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return failure;
  }
}
