// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/configuration_path.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/first_configuration.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {

std::string configuration_path(const std::string& named, const std::string& standard) {
  if (!named.empty()) {
    return named;
  }
  // An existing but unreadable file is reported when it is read.
  std::error_code error;
  if (!std::filesystem::exists(standard, error) && !error) {
    throw ConfigurationError(
        concat({standard, ": is absent; must say which radars there are and where: ", kWriteFirst,
                ", without --replay from what is on the buses; cremed.toml in share/cremed/config "
                "explains every key; --config FILE names another file"}));
  }
  return standard;
}

bool is_unwritten(const std::string& standard) {
  std::error_code error;
  if (!std::filesystem::exists(standard, error)) {
    return !error;
  }
  std::ifstream file(standard);
  const bool is_readable = file.good();
  std::string line;
  while (std::getline(file, line)) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin != std::string::npos && line[begin] != '#') {
      return false;
    }
  }
  return is_readable;
}

}  // namespace cremed
