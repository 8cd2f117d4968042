// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/csv_matrix.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace cremed {
namespace {

double finite_number(const CsvTable& table, std::size_t row, const char* name) {
  const double value = table.number(row, table.column(name));
  if (!std::isfinite(value)) {
    throw std::runtime_error("row " + std::to_string(row + 1) + ", " + name +
                             ": an estimate that is not finite");
  }
  return value;
}

}  // namespace

Eigen::Vector3d read_vector(const CsvTable& table, std::size_t row, const VectorColumns& names) {
  Eigen::Vector3d vector;
  for (std::size_t i = 0; i < names.size(); ++i) {
    vector(static_cast<Eigen::Index>(i)) = finite_number(table, row, names[i]);
  }
  return vector;
}

Eigen::Matrix3d read_symmetric(const CsvTable& table, std::size_t row,
                               const SymmetricColumns& names) {
  const auto number = [&](std::size_t i) { return finite_number(table, row, names[i]); };
  Eigen::Matrix3d matrix;
  matrix << number(0), number(1), number(2),  //
      number(1), number(3), number(4),        //
      number(2), number(4), number(5);
  return matrix;
}

}  // namespace cremed
