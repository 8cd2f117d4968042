// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace cremed {

/// Text that is safe on a terminal: control characters (C0 but line feed and tab, and C1) and
/// invalid UTF-8 become '?'. Logs, files and names may hold terminal commands.
std::string plain_text(std::string_view text);

/// Without the byte order mark by which editors say UTF-8, if the text begins with it.
std::string_view without_byte_order_mark(std::string_view text);

/// Number of bytes of an incomplete sequence at the end: 0 to 3.
std::size_t unfinished_bytes(std::string_view text);

}  // namespace cremed
