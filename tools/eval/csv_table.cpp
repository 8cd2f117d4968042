// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "daemon/process/plain_text.hpp"
#include "daemon/process/whole_number.hpp"

namespace cremed {
namespace {

std::vector<std::string> split(std::string_view line) {
  if (line.ends_with('\r')) {
    line.remove_suffix(1);
  }
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.emplace_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return cells;
}

}  // namespace

CsvTable::CsvTable(std::istream& input) {
  std::string line;
  if (!std::getline(input, line)) {
    throw std::runtime_error("line 1: no header");
  }
  header_ = split(without_byte_order_mark(line));
  for (std::size_t number = 2; std::getline(input, line); ++number) {
    if (line.empty() || line.front() == '#') {
      continue;
    }
    rows_.push_back(split(line));
    lines_.push_back(number);
    if (rows_.back().size() != header_.size()) {
      throw std::runtime_error("line " + std::to_string(number) + ": " +
                               std::to_string(rows_.back().size()) + " cells, the header has " +
                               std::to_string(header_.size()));
    }
  }
}

std::size_t CsvTable::column(std::string_view name) const {
  const auto found = std::ranges::find(header_, name);
  if (found == header_.end()) {
    throw std::runtime_error("no column " + std::string(name));
  }
  return static_cast<std::size_t>(found - header_.begin());
}

bool CsvTable::has_column(std::string_view name) const {
  return std::ranges::find(header_, name) != header_.end();
}

template <typename Number>
Number CsvTable::parse(std::size_t row, std::size_t column) const {
  const std::string& cell = text(row, column);
  const auto value = whole_number<Number>(cell);
  if (!value) {
    throw std::runtime_error(line(row) + ", " + header_[column] + ": '" + cell +
                             "' is not a number");
  }
  return *value;
}

double CsvTable::number(std::size_t row, std::size_t column) const {
  return parse<double>(row, column);
}

double CsvTable::finite(std::size_t row, std::size_t column) const {
  const double value = number(row, column);
  if (!std::isfinite(value)) {
    throw std::runtime_error(line(row) + ", " + header_[column] + ": '" + text(row, column) +
                             "' is not finite; must be a number");
  }
  return value;
}

std::string CsvTable::line(std::size_t row) const { return "line " + std::to_string(lines_[row]); }

long long CsvTable::integer(std::size_t row, std::size_t column) const {
  return parse<long long>(row, column);
}

long long CsvTable::utime_us(std::size_t row, std::size_t column) const {
  if (const std::string& cell = text(row, column); cell.find('.') != std::string::npos) {
    throw std::runtime_error(line(row) + ", " + header_[column] + ": '" + cell +
                             "': is it in seconds? Whole microseconds are expected");
  }
  return integer(row, column);
}

Eigen::Vector3d read_vector(const CsvTable& table, std::size_t row, const VectorColumns& names) {
  Eigen::Vector3d vector;
  for (std::size_t i = 0; i < names.size(); ++i) {
    vector(static_cast<Eigen::Index>(i)) = table.finite(row, table.column(names[i]));
  }
  return vector;
}

Eigen::Matrix3d read_symmetric(const CsvTable& table, std::size_t row,
                               const SymmetricColumns& names) {
  const auto number = [&](std::size_t i) { return table.finite(row, table.column(names[i])); };
  Eigen::Matrix3d matrix;
  matrix << number(0), number(1), number(2),  //
      number(1), number(3), number(4),        //
      number(2), number(4), number(5);
  return matrix;
}

}  // namespace cremed
