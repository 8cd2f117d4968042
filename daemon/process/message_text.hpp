// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

#include "cremed/can_decoders/hexadecimal.hpp"

// Parts of error messages, independent of the locale.
namespace cremed {

/// A text from a file made fit for a message: control characters replaced, cut when long.
std::string printable(std::string_view text);

std::string concat(std::initializer_list<std::string_view> parts);

/// Shortest digits that reproduce the number.
std::string digits(double value);

std::string number(std::uint64_t count);

/// One decimal: "13.6"
std::string tenths(double value);

/// "1 frame", "2 frames"
std::string counted(std::uint64_t count, std::string_view noun);

/// Printable, in double quotes.
std::string in_quotes(std::string_view text);

/// A path as an argument of a shell's command: whole, and in single quotes where it needs some.
std::string in_shell(std::string_view path);

/// "a number from 0 to 1"
std::string range_text(std::string_view what, std::string_view min, std::string_view max);

/// "a", "b" or "c", each in quotes.
std::string list_text(std::span<const std::string_view> names);

}  // namespace cremed
