// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/configuration_edit.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <regex>
#include <stdexcept>

#include "daemon/configuration/toml.hpp"
#include "daemon/configuration/toml_document.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/process/plain_text.hpp"

namespace cremed {
namespace {

constexpr std::string_view kBlank = " \t";

struct Edit {
  std::size_t begin = 0;
  std::size_t length = 0;
  std::string replacement;
};

std::string assignment(const CalibratedValue& value) {
  return std::string(value.key->key) + " = " + value.text;
}

std::string dotted(const CalibratedValue& value) {
  return std::string(value.key->table) + "." + assignment(value);
}

/// Collects the edits of one text without byte order mark; toml++ gives the positions of its nodes.
class ConfigurationEditor {
 public:
  ConfigurationEditor(std::string_view text, const toml::table& document)
      : text_(text), document_(document) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\n') {
        starts_.push_back(i + 1);
      }
    }
    starts_.push_back(text.size());
  }

  void set(std::size_t radar, const CalibratedValue& value) {
    const toml::table& table = *document_["radar"][radar].as_table();
    const std::string name = table["name"].value_or(std::string());
    if (!set_where(document_["calibrated"][name], table[value.key->table], value)) {
      add_table(table, value);
    }
  }

  void set(const CalibratedValue& value) {
    if (!set_where(document_["calibrated"], document_[value.key->table], value)) {
      const std::size_t end = starts_.size() - 2;
      add_line_after(line(end).empty() ? end - 1 : end,
                     concat({"[", value.key->table, "]\n", assignment(value)}));
    }
  }

  [[nodiscard]] std::string result() const {
    std::vector<Edit> edits = edits_;
    std::ranges::stable_sort(edits, std::ranges::greater{}, &Edit::begin);
    std::string text(text_);
    for (const Edit& edit : edits) {
      text.replace(edit.begin, edit.length, edit.replacement);
    }
    return text;
  }

 private:
  using TableView = toml::node_view<const toml::node>;

  /// In the table that overrides, if it has the key, else in its own table; false if that is
  /// absent.
  bool set_where(TableView overriding, TableView own, const CalibratedValue& value) {
    const toml::node* node = overriding[value.key->key].node();
    node = node != nullptr ? node : own[value.key->key].node();
    const toml::table* const table = own.as_table();
    if (node != nullptr) {
      replace_number(*node, value);
    } else if (table != nullptr) {
      add_to_table(*table, value);
    }
    return node != nullptr || table != nullptr;
  }

  void replace_number(const toml::node& node, const CalibratedValue& value) {
    const std::size_t begin = offset_of(node.source().begin);
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n,}#", begin), text_.size());
    edits_.push_back({begin, end - begin, value.text});
  }

  /// A table of dotted keys begins at its first key.
  void add_to_table(const toml::table& table, const CalibratedValue& value) {
    if (table.is_inline()) {
      add_to_inline(table, assignment(value));
      return;
    }
    const std::size_t header = table.source().begin.line - 1;
    if (is_header(header)) {
      add_to_section(header, value);
    } else {
      add_line_after(table.begin()->second.source().begin.line - 1, dotted(value));
    }
  }

  /// Later edits at one position are placed before earlier ones.
  void add_to_inline(const toml::table& table, const std::string& assigned) {
    const std::size_t inside = offset_of(table.source().begin) + 1;
    const bool is_first =
        table.empty() && std::ranges::none_of(edits_, [&](auto& e) { return e.begin == inside; });
    edits_.push_back({inside, 0, " " + assigned + (is_first ? " " : ",")});
  }

  void add_to_section(std::size_t header, const CalibratedValue& value) {
    for (std::size_t i = header + 1; i + 1 < starts_.size() && !is_header(i); ++i) {
      if (auto edit = uncommented(i, value)) {
        edits_.push_back(*edit);
        return;
      }
    }
    add_line_after(header, assignment(value));
  }

  /// Dotted keys may stand among the radar's own keys.
  void add_table(const toml::table& radar, const CalibratedValue& value) {
    if (radar.is_inline()) {
      add_to_inline(radar, dotted(value));
      return;
    }
    const toml::table* mount = radar["mount"].as_table();
    const toml::table& above = mount != nullptr && mount->is_inline() ? *mount : radar;
    add_line_after(above.source().begin.line - 1, dotted(value));
  }

  void add_line_after(std::size_t index, const std::string& added) {
    const bool has_end = line(index).ends_with('\n');
    const std::string end = line(index).ends_with("\r\n") ? "\r\n" : "\n";
    edits_.push_back({starts_[index + 1], 0, has_end ? added + end : end + added});
  }

  [[nodiscard]] std::size_t offset_of(const toml::source_position& at) const {
    return starts_[at.line - 1] + at.column - 1;
  }
  [[nodiscard]] std::string_view line(std::size_t index) const {
    return text_.substr(starts_[index], starts_[index + 1] - starts_[index]);
  }

  [[nodiscard]] bool is_header(std::size_t index) const {
    const std::string_view content = line(index);
    const std::size_t first = content.find_first_not_of(kBlank);
    return first != std::string_view::npos && content[first] == '[';
  }

  /// Replaces "#key = default" by "key = value".
  [[nodiscard]] std::optional<Edit> uncommented(std::size_t index,
                                                const CalibratedValue& value) const {
    const std::regex commented("[ \\t]*(#[ \\t]*" + std::string(value.key->key) +
                               "[ \\t]*=[ \\t]*[^ \\t\\r\\n#]*)");
    const std::string content(line(index));
    std::smatch found;
    if (!std::regex_search(content, found, commented, std::regex_constants::match_continuous)) {
      return std::nullopt;
    }
    return Edit{starts_[index] + static_cast<std::size_t>(found.position(1)),
                static_cast<std::size_t>(found.length(1)), assignment(value)};
  }

  std::string_view text_;
  const toml::table& document_;
  std::vector<std::size_t> starts_ = {0};  // Of lines, and the end.
  std::vector<Edit> edits_;
};

bool reads_as(std::string_view edited, std::string_view text,
              const std::vector<std::vector<CalibratedValue>>& radars,
              const std::vector<CalibratedValue>& vehicle) {
  const Configuration before = parse_configuration(text, "before");
  const Configuration after = parse_configuration(edited, "edited");
  bool is_right = after.radars.size() == before.radars.size();
  for (std::size_t i = 0; is_right && i < radars.size(); ++i) {
    is_right = has_values(after.radars[i], before.radars[i], radars[i]);
  }
  const double slip = after.odometry.filter.slip_per_lateral_acceleration;
  const double wanted = vehicle.empty() ? before.odometry.filter.slip_per_lateral_acceleration
                                        : std::strtod(vehicle[0].text.c_str(), nullptr);
  return is_right && slip == wanted;
}

}  // namespace

std::string edited_configuration(std::string_view text,
                                 const std::vector<std::vector<CalibratedValue>>& radars,
                                 const std::vector<CalibratedValue>& vehicle) {
  const std::string_view body = without_byte_order_mark(text);
  Diagnostics diagnostics("configuration");
  const auto document = parse_toml(text, diagnostics);
  if (document == nullptr) {
    throw std::runtime_error(diagnostics.text());
  }
  ConfigurationEditor editor(body, *document);
  for (std::size_t i = 0; i < radars.size(); ++i) {
    for (const CalibratedValue& value : radars[i]) {
      editor.set(i, value);
    }
  }
  for (const CalibratedValue& value : vehicle) {
    editor.set(value);
  }
  std::string edited = std::string(text.substr(0, text.size() - body.size())) + editor.result();
  try {
    if (reads_as(edited, text, radars, vehicle)) {
      return edited;
    }
  } catch (const ConfigurationError&) {  // Reported below.
  }
  throw std::runtime_error(
      "the configuration is written in a way that cannot be edited; nothing was written: paste the "
      "tables on standard output");
}

}  // namespace cremed
