// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace cremed {

inline constexpr const char* kStandardConfiguration = "/etc/cremed/cremed.toml";

/// The file that --config names; without one the standard one. Where that is absent too it throws
/// ConfigurationError: mounts cannot be guessed, and an example's would give wrong odometry.
std::string configuration_path(const std::string& named,
                               const std::string& standard = kStandardConfiguration);

}  // namespace cremed
