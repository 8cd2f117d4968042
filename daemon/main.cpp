// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <string>

#include <spdlog/spdlog.h>

#include "cremed/version.hpp"
#include "daemon/command_line.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/configuration_path.hpp"
#include "daemon/configuration/configuration_summary.hpp"
#include "daemon/process/process_setup.hpp"
#include "daemon/process/usage_error.hpp"
#include "daemon/report/log_sink.hpp"
#include "daemon/run_live.hpp"
#include "daemon/run_replay.hpp"

namespace {

enum ExitStatus : int { good = 0, failure = 1, bad_usage = 2 };

int check(const std::string& path) {
  const auto configuration = cremed::load_configuration(path);
  cremed::refuse_outputs({}, path, configuration);
  std::fputs(cremed::configuration_summary(configuration).c_str(), stdout);
  for (const std::string& doubt : cremed::configuration_doubts(configuration)) {
    spdlog::warn("{}", doubt);
  }
  spdlog::info("{}: good, number of radars: {}", path, configuration.radars.size());
  return good;
}

int run(const cremed::CommandLine& command_line, cremed::LogSink& log) {
  if (command_line.check_config) {
    const std::string& checked = *command_line.check_config;
    return check(cremed::configuration_path(checked.empty() ? command_line.config : checked));
  }
  const bool is_live = command_line.replay.empty();
  if (is_live) {
    log.drop_when_full();
  }
  const std::string path = cremed::configuration_path(command_line.config);
  const auto configuration = cremed::load_configuration(path, command_line);
  spdlog::set_level(spdlog::level::from_str(configuration.logging.level));
  spdlog::info("cremed {}", CREMED_VERSION);
  cremed::log_configuration(path, configuration);
  return is_live ? cremed::run_live(command_line, path, configuration)
                 : cremed::run_replay(command_line, path, configuration);
}

}  // namespace

int main(int argc, char** argv) {
  cremed::set_up_process();
  const auto log = cremed::log_to_standard_error();
  const cremed::CommandLineResult result = cremed::parse_command_line(argc, argv);
  if (!result.command_line) {
    return cremed::finish_process(result.exit_status);
  }
  try {
    return cremed::finish_process(run(*result.command_line, *log));
  } catch (const cremed::UsageError& error) {
    spdlog::error("{}", error.what());
    return bad_usage;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return failure;
  }
}
