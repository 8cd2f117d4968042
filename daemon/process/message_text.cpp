// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/message_text.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include <spdlog/fmt/fmt.h>

#include "daemon/process/plain_text.hpp"

namespace cremed {
namespace {

constexpr std::size_t kMaxPrintable = 60;
/// Characters without a special meaning in any shell.
constexpr std::string_view kUnquoted =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789/._-+,:@%";

std::string one_line(std::string_view text) {
  std::string line = plain_text(text);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\t'; }, '?');
  return line;
}

}  // namespace

std::string printable(std::string_view text) {
  if (text.size() <= kMaxPrintable) {
    return one_line(text);
  }
  const std::string_view begin = text.substr(0, kMaxPrintable);
  return one_line(begin.substr(0, begin.size() - unfinished_bytes(begin))) + "...";
}

std::string concat(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) {
    text += part;
  }
  return text;
}

std::string digits(double value) {
  std::array<char, 32> text{};
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

std::string tenths(double value) {
  std::string text = fmt::format("{:.1f}", value);
  return text == "-0.0" ? "0.0" : text;
}

std::string number(std::uint64_t count) { return std::to_string(count); }

std::string counted(std::uint64_t count, std::string_view noun) {
  return concat({number(count), " ", noun, count == 1 ? "" : "s"});
}

std::string in_quotes(std::string_view text) { return concat({"\"", printable(text), "\""}); }

std::string in_shell(std::string_view path) {
  std::string text = one_line(path);
  if (!text.empty() && text.find_first_not_of(kUnquoted) == std::string::npos) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

std::string range_text(std::string_view what, std::string_view min, std::string_view max) {
  return concat({what, " from ", min, " to ", max});
}

std::string list_text(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += i == 0 ? "" : i + 1 == names.size() ? " or " : ", ";
    text += in_quotes(names[i]);
  }
  return text;
}

}  // namespace cremed
