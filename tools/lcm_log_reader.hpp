// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cremed {

struct LoggedMessage {
  std::int64_t recorded_us = 0;
  std::string channel;
  std::vector<std::uint8_t> data;
};

/// A message of LCM's generated types; nothing if these bytes are not exactly one.
template <typename Message>
std::optional<Message> decoded(const void* data, std::size_t bytes) {
  Message message;
  try {
    const auto size = static_cast<int>(bytes);
    return message.decode(data, 0, size) == size ? std::optional(message) : std::nullopt;
  } catch (const std::exception&) {  // The generated code turns a string length of 0 into -1.
    return std::nullopt;
  }
}

/// Reads the messages of an LCM log. LCM's own reader trusts the lengths that a log states, and
/// crashes on damaged ones.
class LcmLogReader {
 public:
  /// Throws std::runtime_error if the log cannot be read.
  explicit LcmLogReader(const std::string& path);

  /// The next message; null at the end of the log, or where it is damaged.
  const LoggedMessage* next();
  /// What is wrong with the log after the last message, and where; empty if nothing.
  [[nodiscard]] const std::string& damage() const { return damage_; }

 private:
  const LoggedMessage* end(std::string_view damage);
  std::size_t read_some(std::size_t size);

  std::ifstream input_;
  std::string path_;
  std::vector<std::uint8_t> bytes_;  // Of the message that is read, with its header.
  std::uint64_t at_ = 0;             // Where it begins.
  LoggedMessage message_;
  std::string damage_;
};

}  // namespace cremed
