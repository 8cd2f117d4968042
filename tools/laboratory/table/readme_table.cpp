// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/table/readme_table.hpp"

#include <algorithm>
#include <cstddef>

namespace cremed {
namespace {

std::string comment(std::string_view name) {
  return "<!-- cremed-eval table --drives: " + std::string(name) + " -->\n";
}

std::string line_of(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += " " + cell + " |";
  }
  return line + "\n";
}

/// Comment and table.
struct Place {
  std::size_t begin = 0;
  std::size_t table = 0;
  std::size_t end = 0;
};

std::optional<Place> find(const std::string& readme, std::string_view name) {
  const std::string title = comment(name);
  const std::size_t begin = readme.find(title);
  if (begin == std::string::npos) {
    return std::nullopt;
  }
  Place place{begin, begin + title.size(), begin + title.size()};
  while (place.end < readme.size() && readme[place.end] == '|') {
    place.end = readme.find('\n', place.end);
    place.end = place.end == std::string::npos ? readme.size() : place.end + 1;
  }
  return place;
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 2; begin < line.size();) {
    const std::size_t end = line.find(" |", begin);
    cells.emplace_back(line.substr(begin, end - begin));
    begin = end == std::string_view::npos ? end : end + 3;
  }
  return cells;
}

}  // namespace

std::string to_markdown(const ReadmeTable& table) {
  std::string text = comment(table.name) + line_of(table.header) + "|";
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    text += "---|";
  }
  text += "\n";
  for (const auto& row : table.rows) {
    text += line_of(row);
  }
  return text;
}

std::optional<std::vector<std::vector<std::string>>> rows_in(const std::string& readme,
                                                             std::string_view name) {
  const auto place = find(readme, name);
  if (!place) {
    return std::nullopt;
  }
  std::vector<std::vector<std::string>> rows;
  std::size_t line = 0;
  for (std::size_t begin = place->table; begin < place->end; ++line) {
    const std::size_t end = std::min(readme.find('\n', begin), place->end);
    if (line >= 2) {
      rows.push_back(cells_of(std::string_view(readme).substr(begin, end - begin)));
    }
    begin = end + 1;
  }
  return rows;
}

std::string with_table(const std::string& readme, const ReadmeTable& table) {
  const auto place = find(readme, table.name);
  return place ? readme.substr(0, place->begin) + to_markdown(table) + readme.substr(place->end)
               : readme;
}

}  // namespace cremed
