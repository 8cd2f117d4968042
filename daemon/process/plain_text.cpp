// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/process/plain_text.hpp"

#include <algorithm>
#include <cstdint>

namespace cremed {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// Length of the UTF-8 sequence that begins with this byte; 0: invalid.
std::size_t length_of(unsigned char first) {
  if (first < 0x80U) {
    return 1;
  }
  return first < 0xC2U ? 0 : first < 0xE0U ? 2 : first < 0xF0U ? 3 : first < 0xF5U ? 4 : 0;
}

/// Length of the complete sequence at the beginning of the text; 0 if there is none.
std::size_t whole_length(std::string_view text) {
  const std::size_t length = length_of(static_cast<unsigned char>(text.front()));
  const bool is_whole =
      length != 0 && length <= text.size() &&
      std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length), continues);
  return is_whole ? length : 0;
}

/// One complete sequence.
std::uint32_t code_of(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  std::uint32_t code = character.size() == 1 ? first : first & (0x7FU >> character.size());
  for (const char c : character.substr(1)) {
    code = code << 6U | (static_cast<unsigned char>(c) & 0x3FU);
  }
  return code;
}

bool is_control(std::uint32_t code) {
  return (code < 0x20U && code != '\n' && code != '\t') || (code >= 0x7FU && code < 0xA0U);
}

}  // namespace

std::string plain_text(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = whole_length(text);
    const bool is_plain = length != 0 && !is_control(code_of(text.substr(0, length)));
    plain += is_plain ? text.substr(0, length) : "?";
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return plain;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(text.starts_with(kMark) ? kMark.size() : 0);
}

std::size_t unfinished_bytes(std::string_view text) {
  const std::size_t most = std::min<std::size_t>(text.size(), 3);
  for (std::size_t bytes = 1; bytes <= most; ++bytes) {
    const char c = text[text.size() - bytes];
    if (!continues(c)) {
      return length_of(static_cast<unsigned char>(c)) > bytes ? bytes : 0;
    }
  }
  return 0;
}

}  // namespace cremed
