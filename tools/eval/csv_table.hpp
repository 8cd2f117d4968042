// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace cremed {

/// A CSV file with a header line, as text cells. Throws std::runtime_error "line N: ..."; lines are
/// those of the file, with its header and comments.
class CsvTable {
 public:
  explicit CsvTable(std::istream& input);

  /// Index of a column; throws std::runtime_error that names it if there is none.
  [[nodiscard]] std::size_t column(std::string_view name) const;
  [[nodiscard]] bool has_column(std::string_view name) const;
  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  [[nodiscard]] const std::string& text(std::size_t row, std::size_t column) const {
    return rows_[row][column];
  }
  /// "line 3" of the file.
  [[nodiscard]] std::string line(std::size_t row) const;
  /// A cell as a number ("nan" is one); throws std::runtime_error.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;
  /// A cell as a number that is finite; throws std::runtime_error.
  [[nodiscard]] double finite(std::size_t row, std::size_t column) const;
  /// A cell as an integer; throws std::runtime_error.
  [[nodiscard]] long long integer(std::size_t row, std::size_t column) const;
  /// The same for a time stamp: asks about seconds.
  [[nodiscard]] long long utime_us(std::size_t row, std::size_t column) const;

 private:
  template <typename Number>
  [[nodiscard]] Number parse(std::size_t row, std::size_t column) const;

  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> lines_;  // Of each row.
};

/// Names of the columns of a symmetric matrix: first row, second from its diagonal, last.
using SymmetricColumns = std::array<const char*, 6>;
using VectorColumns = std::array<const char*, 3>;

inline constexpr VectorColumns kPoseColumns{"x_m", "y_m", "yaw_rad"};
inline constexpr SymmetricColumns kPoseCovarianceColumns{"cov_xx", "cov_xy",   "cov_xyaw",
                                                         "cov_yy", "cov_yyaw", "cov_yawyaw"};

/// Cells of a row; throws std::runtime_error where one is not finite.
Eigen::Vector3d read_vector(const CsvTable& table, std::size_t row, const VectorColumns& names);
Eigen::Matrix3d read_symmetric(const CsvTable& table, std::size_t row,
                               const SymmetricColumns& names);

}  // namespace cremed
