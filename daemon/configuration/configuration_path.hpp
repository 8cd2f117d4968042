// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

inline constexpr const char* kStandardConfiguration = "/etc/cremed/cremed.toml";

/// The path given by --config, else the standard path. Throws ConfigurationError if that file does
/// not exist: there is no default for mounts.
std::string configuration_path(const std::string& named,
                               const std::string& standard = kStandardConfiguration);

/// Whether the standard file is absent, or as the package installs it: comments only.
bool is_unwritten(const std::string& standard = kStandardConfiguration);

}  // namespace cremed
