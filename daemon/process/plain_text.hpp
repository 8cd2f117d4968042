// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace cremed {

/// UTF-8 that only prints: logs, files and names may hold what a terminal takes for commands. All
/// control characters but line feed and tab (those of C1 too), and what is no UTF-8, become '?'.
std::string plain_text(std::string_view text);

/// How many bytes at its end are the beginning of a character: 0 to 3.
std::size_t unfinished_bytes(std::string_view text);

}  // namespace cremed
