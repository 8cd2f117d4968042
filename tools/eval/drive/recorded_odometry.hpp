// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "tools/eval/csv_table.hpp"
#include "tools/eval/drive/time_bracket.hpp"

namespace cremed {

/// A row of a recorded odometry, and whether it has a usable estimate.
struct RowTime {
  std::int64_t utime_us = 0;
  bool is_usable = false;
};

struct Availability {
  double percent = std::numeric_limits<double>::quiet_NaN();  ///< Of the drive's time.
  std::vector<TimeSpan> without;                              ///< In order.
};

/// For how much of the drive there was a usable estimate: a usable row tells of the time since the
/// row before it, unless that is a pause (longest_step_us), in which the odometry predicts only.
/// tools/report/availability.py does the same.
Availability availability(const std::vector<RowTime>& rows, const TimeSpan& drive);

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
bool is_estimate(std::string_view status);

/// From the first to the last row of all sources.
TimeSpan time_of(const CsvTable& table);

/// Odometry CSV as cremed writes it; sources in order of appearance. Throws std::runtime_error.
std::vector<RecordedOdometry> read_odometry(const CsvTable& table);

/// 2 if no estimate has a variance of y, else 3.
int degrees_of_freedom(const RecordedOdometry& odometry);

}  // namespace cremed
