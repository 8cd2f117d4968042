// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/csv_table.hpp"
#include "tools/eval/drive/availability.hpp"

namespace cremed {

/// A row of odometry CSV that holds an estimate. Order of states: (x_m, y_m, yaw_rad).
struct RecordedEstimate {
  std::int64_t start_us = 0;
  std::int64_t end_us = 0;
  Eigen::Vector3d motion;
  Eigen::Matrix3d covariance;
};

/// The rows of one source, in order.
struct RecordedOdometry {
  std::string source;
  std::vector<RecordedEstimate> estimates;
  std::size_t without_estimate = 0;  ///< Rows whose status has no estimate.
  /// From each pose since the start to the next, without covariance. Only if the estimates are
  /// relative to anchors: otherwise they are steps themselves.
  std::vector<RecordedEstimate> steps_since_start{};
  Availability availability{};  ///< Of rows that cremed wrote.

  [[nodiscard]] const std::vector<RecordedEstimate>& steps() const {
    return steps_since_start.empty() ? estimates : steps_since_start;
  }
};

/// Whether rows with that status have an estimate.
bool is_estimate(const std::string& status);

/// From the first to the last row of all sources.
TimeSpan time_of(const CsvTable& table);

/// Odometry CSV as cremed writes it; sources in order of appearance. Throws std::runtime_error.
std::vector<RecordedOdometry> read_odometry(const CsvTable& table);

/// 2 if no estimate has a variance of y, else 3.
int degrees_of_freedom(const RecordedOdometry& odometry);

}  // namespace cremed
