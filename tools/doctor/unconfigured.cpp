// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/unconfigured.hpp"

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "daemon/configuration/configuration_path.hpp"
#include "tools/doctor/suggestion.hpp"

namespace cremed {

Configuration without_radars() {
  Configuration nothing;
  nothing.odometry.enabled = false;
  return nothing;
}

bool is_unconfigured(const std::string& named) { return named.empty() && is_unwritten(); }

bool is_pipe(const std::string& log) {
  std::error_code error;
  return log == "-" || std::filesystem::is_fifo(log, error);
}

Configuration examined_radars(const Observation& observation) {
  Configuration configuration = examined_configuration(observation);
  if (configuration.radars.empty()) {
    throw std::runtime_error(no_suggestion(observation));
  }
  return configuration;
}

}  // namespace cremed
