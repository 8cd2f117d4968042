// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "tools/eval/csv_table.hpp"

namespace cremed {

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
