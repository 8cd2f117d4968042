// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/toml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cremed/estimator/scan/degrees.hpp"
#include "daemon/configuration/spelling.hpp"
#include "daemon/configuration/toml.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

std::string float_text(double value) {
  const std::string text = digits(value);
  return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
}

std::string describe(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return in_quotes(node.as_string()->get());
    case toml::node_type::integer:
      return std::to_string(node.as_integer()->get());
    case toml::node_type::floating_point:
      return float_text(node.as_floating_point()->get());
    case toml::node_type::boolean:
      return node.as_boolean()->get() ? "true" : "false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a table";
    default:
      return "a date or time";
  }
}

/// An integer may not be written as a float.
std::optional<std::int64_t> integer_in(const toml::node& node, std::int64_t min, std::int64_t max) {
  const auto integer = node.value_exact<std::int64_t>();
  return integer && *integer >= min && *integer <= max ? integer : std::nullopt;
}

/// A hint for an angle that would be valid in degrees.
std::string degrees_hint(std::string_view key, std::optional<double> value, Range range) {
  const double angle_rad = value.value_or(0.0) * kRadPerDeg;
  const bool is_likely = key.ends_with("_rad") && value && std::abs(*value) >= 1.0 &&
                         angle_rad >= range.min && angle_rad <= range.max;
  return is_likely ? concat({" (", digits(*value), " degrees are ",
                             digits(std::round(angle_rad * 1e4) / 1e4), ")"})
                   : "";
}

bool has_control_character(std::string_view text) {
  // char is signed on some processors; bytes of UTF-8 are none of these.
  return std::ranges::any_of(text, [](unsigned char c) { return c < ' ' || c == '\x7F'; });
}

bool contains(const std::vector<std::string_view>& keys, std::string_view key) {
  return std::ranges::find(keys, key) != keys.end();
}

}  // namespace

TomlReader::TomlReader(const toml::table* table, std::string path, std::size_t line,
                       Diagnostics& diagnostics)
    : table_(table), path_(std::move(path)), line_(line), diagnostics_(&diagnostics) {}

template <typename Read>
auto TomlReader::value_of(std::string_view key, Presence presence, std::string_view wanted,
                          const Read& read) {
  const toml::node* const node = take(key, presence, wanted);
  auto value = node == nullptr ? std::nullopt : read(*node);
  if (node != nullptr && !value) {
    report_wrong(key, *node, wanted);
  }
  return value;
}

void TomlReader::number(std::string_view key, double& value, Range range, Presence presence) {
  const std::string wanted = range_text("a number", digits(range.min), digits(range.max));
  if (const toml::node* node = take(key, presence, wanted)) {
    const auto read = node->value<double>();                 // May be written as an integer.
    if (read && *read >= range.min && *read <= range.max) {  // false for NaN
      value = *read;
    } else {
      report_wrong(key, *node, wanted + degrees_hint(key, read, range));
    }
  }
}

std::optional<std::int64_t> TomlReader::integer_within(std::string_view key, std::int64_t min,
                                                       std::int64_t max) {
  return value_of(key, Presence::optional,
                  range_text("an integer", std::to_string(min), std::to_string(max)),
                  [&](const toml::node& node) { return integer_in(node, min, max); });
}

void TomlReader::identifier(std::string_view key, std::uint32_t& value, std::uint32_t max) {
  const std::string wanted = range_text("a CAN identifier", hexadecimal(0), hexadecimal(max));
  if (const toml::node* node = take(key, Presence::optional, wanted)) {
    if (const auto read = integer_in(*node, 0, max)) {
      value = static_cast<std::uint32_t>(*read);
    } else if (const auto number = integer_in(*node, 0, std::numeric_limits<std::int64_t>::max())) {
      report(key, concat({"is ", hexadecimal(static_cast<std::uint64_t>(*number)), "; must be ",
                          wanted}));
    } else {
      report_wrong(key, *node, wanted);
    }
  }
}

void TomlReader::boolean(std::string_view key, bool& value) {
  const auto read = [](const toml::node& node) { return node.value_exact<bool>(); };
  value = value_of(key, Presence::optional, "true or false", read).value_or(value);
}

void TomlReader::text(std::string_view key, std::string& value, const TextRule& rule,
                      Presence presence) {
  const auto accepted = [&](const toml::node& node) {
    const auto text = node.value_exact<std::string>();
    return text && !has_control_character(*text) && rule.accepts(*text) ? text : std::nullopt;
  };
  value = value_of(key, presence, rule.wanted, accepted).value_or(value);
}

std::optional<std::size_t> TomlReader::choice(std::string_view key,
                                              std::span<const std::string_view> names,
                                              Presence presence) {
  const auto index = [&](const toml::node& node) {
    const auto name = node.value_exact<std::string_view>();
    const auto found = name ? std::ranges::find(names, *name) : names.end();
    return found == names.end() ? std::nullopt : std::optional<std::size_t>(found - names.begin());
  };
  return value_of(key, presence, list_text(names), index);
}

void TomlReader::bits(std::string_view key, std::uint32_t& mask, std::int64_t max_code) {
  const std::string wanted =
      range_text("a list of one or more integers", "0", std::to_string(max_code));
  const toml::node* node = take(key, Presence::optional, wanted);
  if (node == nullptr) {
    return;
  }
  const toml::array* list = node->as_array();
  std::uint32_t read = 0;
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    if (const auto code = integer_in((*list)[i], 0, max_code)) {
      read |= 1U << static_cast<unsigned>(*code);
    } else {
      report(key, concat({"holds ", describe((*list)[i]), "; must be ", wanted}));
      return;
    }
  }
  if (list == nullptr) {
    report_wrong(key, *node, wanted);
  } else if (list->empty()) {
    report(key, concat({"is empty; must be ", wanted}));
  } else {
    mask = read;
  }
}

TomlReader TomlReader::table(std::string_view key) {
  const toml::node* node = take(key, Presence::optional, "a table");
  if (node != nullptr && !node->is_table()) {
    report_wrong(key, *node, "a table");
  }
  const toml::table* table = node == nullptr ? nullptr : node->as_table();
  const std::size_t line = table == nullptr ? line_ : std::size_t{table->source().begin.line};
  return {table, path_of(key), line, *diagnostics_};
}

std::vector<TomlReader> TomlReader::tables(std::string_view key, std::string_view if_missing) {
  const std::string wanted = concat({"one or more [[", key, "]] tables"});
  const toml::node* node = take(key, Presence::required, concat({wanted, if_missing}));
  std::vector<TomlReader> readers;
  if (node == nullptr) {
    return readers;
  }
  if (!node->is_array_of_tables()) {
    report_wrong(key, *node, wanted);
    return readers;
  }
  for (const toml::node& element : *node->as_array()) {
    readers.emplace_back(element.as_table(), path_of(key), element.source().begin.line,
                         *diagnostics_);
  }
  return readers;
}

void TomlReader::require_less(std::string_view low_key, double low, std::string_view high_key,
                              double high) {
  if (!clean_ || low < high) {
    return;
  }
  if (has(high_key)) {
    report(high_key,
           concat({"is ", digits(high), "; must be greater than ", low_key, " = ", digits(low)}));
  } else if (has(low_key)) {
    report(low_key,
           concat({"is ", digits(low), "; must be less than ", high_key, " = ", digits(high)}));
  }
}

void TomlReader::refuse(std::span<const std::string_view> keys, std::string_view problem) {
  for (const std::string_view key : keys) {
    if (!contains(known_, key) && !contains(refused_, key) && has(key)) {
      report(key, problem);
      refused_.push_back(key);
    }
  }
}

void TomlReader::finish() {
  if (table_ == nullptr) {
    return;
  }
  for (const auto& [key, node] : *table_) {
    if (!contains(known_, key.str()) && !contains(refused_, key.str())) {
      const std::string_view nearest = nearest_word(key.str(), known_);
      report(key.str(), nearest.empty()
                            ? concat({"unknown key; must be one of ", list_text(known_)})
                            : concat({"unknown key; did you mean ", in_quotes(nearest), "?"}));
    }
  }
}

void TomlReader::report(std::string_view key, std::string_view problem) {
  clean_ = false;
  diagnostics_->add(line_of(key), path_of(key), problem);
}

void TomlReader::report_wrong(std::string_view key, const toml::node& node,
                              std::string_view wanted) {
  report(key, concat({"is ", describe(node), "; must be ", wanted}));
}

bool TomlReader::has(std::string_view key) const {
  return table_ != nullptr && table_->contains(key);
}

std::size_t TomlReader::line_of(std::string_view key) const {
  return has(key) ? std::size_t{table_->find(key)->first.source().begin.line} : line_;
}

std::string TomlReader::path_of(std::string_view key) const {
  return path_.empty() ? printable(key) : concat({path_, ".", printable(key)});
}

const toml::node* TomlReader::take(std::string_view key, Presence presence,
                                   std::string_view wanted) {
  known_.push_back(key);
  if (has(key)) {
    return table_->get(key);
  }
  if (presence == Presence::required) {
    report(key, concat({"is missing; must be ", wanted}));
  }
  return nullptr;
}

}  // namespace cremed
