// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/configuration/diagnostics.hpp"

// toml++ is heavy, so only the .cpp files that need it include it.
namespace toml {
inline namespace v3 {
class table;
}
}  // namespace toml

namespace cremed {

/// Limit for a configuration.
inline constexpr std::size_t kMaxTomlBytes = std::size_t{256} * 1024;

/// Content of a file, cut just above the limit. Throws std::system_error; ENOTSUP if it is not a
/// regular file, which might block or never end.
std::string read_toml(const std::string& path);

/// Adds syntax errors to `diagnostics` and then returns null. Throws nothing.
std::shared_ptr<const toml::table> parse_toml(std::string_view text, Diagnostics& diagnostics);

}  // namespace cremed
