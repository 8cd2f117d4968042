// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <exception>
#include <filesystem>
#include <string>

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "daemon/command_line.hpp"
#include "daemon/configuration.hpp"
#include "daemon/run_replay.hpp"
#include "daemon/version.hpp"

namespace {

enum ExitStatus : int { good = 0, failure = 1, bad_configuration = 2 };

std::string configuration_path(const cremed::CommandLine& command_line) {
  if (!command_line.config.empty()) {
    return command_line.config;
  }
  const std::string local = "/etc/cremed/cremed.toml";
  std::error_code ignored;
  return std::filesystem::exists(local, ignored) ? local : cremed::kInstalledConfiguration;
}

int run(const cremed::CommandLine& command_line) {
  if (!command_line.check_config.empty()) {
    const auto configuration = cremed::load_configuration(command_line.check_config);
    spdlog::info("{}: good, {} radars", command_line.check_config, configuration.radars.size());
    return good;
  }
  const auto configuration = cremed::load_configuration(configuration_path(command_line));
  spdlog::set_level(spdlog::level::from_str(configuration.logging.level));
  return cremed::run_replay(command_line, configuration);
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
    return bad_configuration;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return failure;
  }
}
