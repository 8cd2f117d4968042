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

/// A larger file is no configuration.
inline constexpr std::size_t kMaxTomlBytes = std::size_t{256} * 1024;

/// What a file holds, of a file that is too large only so much that it shows. Throws
/// std::system_error, with ENOTSUP for what is no file: it might never end, or never begin.
std::string read_toml(const std::string& path);

/// Syntax errors are added to `diagnostics`; the result is then null. Throws nothing.
std::shared_ptr<const toml::table> parse_toml(std::string_view text, Diagnostics& diagnostics);

}  // namespace cremed
