// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration_path.hpp"

#include <filesystem>
#include <system_error>

#include "daemon/version.hpp"

namespace cremed {

std::string configuration_path(const std::string& named) {
  if (!named.empty()) {
    return named;
  }
  // Only a file that is not there is passed over: one that cannot be read must be heard of.
  const std::string local = "/etc/cremed/cremed.toml";
  std::error_code error;
  const bool is_absent = !std::filesystem::exists(local, error) && !error;
  return is_absent ? kInstalledConfiguration : local;
}

}  // namespace cremed
