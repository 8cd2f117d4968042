// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace cremed::test {

using TableRows = std::vector<std::vector<std::string>>;

/// The cells of "| a | b |".
inline std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 2; begin < line.size();) {
    const std::size_t end = line.find(" |", begin);
    cells.emplace_back(line.substr(begin, end - begin));
    begin = end == std::string_view::npos ? end : end + 3;
  }
  return cells;
}

/// The rows, without the header, of the table that `cremed-eval table --drives --write` wrote below
/// the comment with its name; nothing if there is no such comment.
inline std::optional<TableRows> rows_in(const std::string& readme, const std::string& name) {
  std::istringstream text(readme);
  std::string line;
  do {
    if (!std::getline(text, line)) {
      return std::nullopt;
    }
  } while (line != "<!-- cremed-eval table --drives: " + name + " -->");
  TableRows rows;
  for (int number = 0; std::getline(text, line) && line.starts_with('|'); ++number) {
    if (number >= 2) {
      rows.push_back(cells_of(line));
    }
  }
  return rows;
}

}  // namespace cremed::test
