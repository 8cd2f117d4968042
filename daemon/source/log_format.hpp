// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace cremed {

/// The format of a file that begins like this and is not a candump log, with the command that
/// converts it; empty if it may be one. `path` is for the text, "-" standard input.
std::string foreign_format(std::string_view begin, const std::string& path);

/// Throws std::runtime_error with that text, unless it is empty.
void refuse_foreign_format(std::string_view begin, const std::string& path);

}  // namespace cremed
