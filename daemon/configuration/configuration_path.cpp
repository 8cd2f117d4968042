// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/configuration_path.hpp"

#include <filesystem>
#include <system_error>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

std::string configuration_path(const std::string& named, const std::string& standard) {
  if (!named.empty()) {
    return named;
  }
  // An existing but unreadable file is reported when it is read.
  std::error_code error;
  if (!std::filesystem::exists(standard, error) && !error) {
    throw ConfigurationError(
        standard +
        ": is absent; must say which radars there are and where: "
        "`cremed-doctor --suggest-config` writes a first one from what is on the buses, "
        "cremed.toml "
        "in share/cremed explains every key; --config FILE names another file");
  }
  return standard;
}

}  // namespace cremed
