// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace cremed {

/// Closed interval.
struct Range {
  double min = 0.0;
  double max = 0.0;
};

/// Reads a radar's options key by key from any format. Errors are reported; an absent or wrong key
/// leaves the value unchanged. Keys must be string literals.
class OptionReader {
 public:
  virtual ~OptionReader() = default;

  virtual void number(std::string_view key, double& value, Range range) = 0;
  template <std::integral Integer>
  void integer(std::string_view key, Integer& value, std::int64_t min, std::int64_t max) {
    if (const auto read = integer_within(key, min, max)) {
      value = static_cast<Integer>(*read);
    }
  }
  /// A non-negative integer, shown in hexadecimal in messages.
  virtual void identifier(std::string_view key, std::uint32_t& value, std::uint32_t max) = 0;
  virtual void boolean(std::string_view key, bool& value) = 0;
  /// Index of the key's name in the list; nothing if the key is absent or wrong.
  virtual std::optional<std::size_t> choice(std::string_view key,
                                            std::span<const std::string_view> names) = 0;
  /// A list of codes from 0 to `max_code`, not empty, as bits.
  virtual void bits(std::string_view key, std::uint32_t& mask, std::int64_t max_code) = 0;

  virtual void report(std::string_view key, std::string_view problem) = 0;
  [[nodiscard]] virtual bool has(std::string_view key) const = 0;
  /// Whether nothing was reported yet.
  [[nodiscard]] virtual bool clean() const = 0;

 protected:
  OptionReader() = default;
  OptionReader(const OptionReader&) = default;
  OptionReader& operator=(const OptionReader&) = default;

  virtual std::optional<std::int64_t> integer_within(std::string_view key, std::int64_t min,
                                                     std::int64_t max) = 0;
};

}  // namespace cremed
