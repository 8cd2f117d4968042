// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/option_reader.hpp"
#include "daemon/configuration/diagnostics.hpp"

namespace toml {
inline namespace v3 {
class node;
class table;
}  // namespace v3
}  // namespace toml

namespace cremed {

enum class Presence : std::uint8_t { optional, required };

/// The allowed strings of a key, and their description after "must be".
struct TextRule {
  bool (*accepts)(std::string_view);
  std::string_view wanted;
};

/// Reads one table key by key: checks type and range, and reports errors. An absent key leaves the
/// value unchanged. Usage:
///
///     reader.number("max_gap_s", options.max_gap_s, {0.01, 10.0});
/// Every key not read is unknown.
class TomlReader final : public OptionReader {
 public:
  /// `table` may be null if the file lacks it; `line` is then where it would be.
  TomlReader(const toml::table* table, std::string path, std::size_t line,
             Diagnostics& diagnostics);

  void number(std::string_view key, double& value, Range range) override {
    number(key, value, range, Presence::optional);
  }
  void number(std::string_view key, double& value, Range range, Presence presence);
  void identifier(std::string_view key, std::uint32_t& value, std::uint32_t max) override;
  void boolean(std::string_view key, bool& value) override;
  void text(std::string_view key, std::string& value, const TextRule& rule,
            Presence presence = Presence::optional);
  std::optional<std::size_t> choice(std::string_view key,
                                    std::span<const std::string_view> names) override {
    return choice(key, names, Presence::optional);
  }
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> names,
                                    Presence presence);
  void bits(std::string_view key, std::uint32_t& mask, std::int64_t max_code) override;

  TomlReader table(std::string_view key);
  /// A required, non-empty list of tables. `if_missing` ends the message then: what helps.
  std::vector<TomlReader> tables(std::string_view key, std::string_view if_missing = {});

  /// Reports `high` unless it is greater than `low`; only if one of them is in this table.
  void require_less(std::string_view low_key, double low, std::string_view high_key, double high);
  /// Reports each of `keys` that is in this table, with `problem`.
  void refuse(std::span<const std::string_view> keys, std::string_view problem);
  /// Reports every key that was not read.
  void finish();

  void report(std::string_view key, std::string_view problem) override;
  [[nodiscard]] bool has(std::string_view key) const override;
  /// Of the key, or of the table if the key is absent.
  [[nodiscard]] std::size_t line_of(std::string_view key) const;
  [[nodiscard]] bool clean() const override { return clean_; }
  [[nodiscard]] const std::vector<std::string_view>& known() const { return known_; }

 private:
  const toml::node* take(std::string_view key, Presence presence, std::string_view wanted);
  /// What `read` makes of the key's node; reports the node if that is nothing.
  template <typename Read>
  auto value_of(std::string_view key, Presence presence, std::string_view wanted, const Read& read);
  std::optional<std::int64_t> integer_within(std::string_view key, std::int64_t min,
                                             std::int64_t max) override;
  void report_wrong(std::string_view key, const toml::node& node, std::string_view wanted);
  [[nodiscard]] std::string path_of(std::string_view key) const;

  const toml::table* table_;
  std::string path_;
  std::size_t line_;
  Diagnostics* diagnostics_;
  std::vector<std::string_view> known_;
  std::vector<std::string_view> refused_;
  bool clean_ = true;
};

}  // namespace cremed
