// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/recorded_states.hpp"

#include <cmath>
#include <optional>
#include <string_view>

#include "tools/eval/csv_table.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {
namespace {

constexpr const char* kAnchorColumn = "utime_anchor";
constexpr VectorColumns kTwistColumns{"vx_mps", "vy_mps", "yaw_rate_radps"};
constexpr SymmetricColumns kTwistCovarianceColumns{"cov_vxvx", "cov_vxvy", "cov_vxw",
                                                   "cov_vyvy", "cov_vyw",  "cov_ww"};

/// A name that cremed does not have counts as a prediction: there is no estimate.
OdometryStatus status_named(std::string_view name) {
  for (std::size_t i = 0; i < kOdometryStatusCount; ++i) {
    if (const auto status = static_cast<OdometryStatus>(i); to_string(status) == name) {
      return status;
    }
  }
  return OdometryStatus::predicted;
}

bool is_usable(const Odometry& output) { return is_estimate(to_string(output.status)); }

Odometry read_output(const CsvTable& table, std::size_t row) {
  const auto number = [&](const char* name) { return table.number(row, table.column(name)); };
  Odometry output;
  output.utime_us = table.integer(row, table.column("utime"));
  output.status = status_named(table.text(row, table.column("status")));
  output.odom_pose << number("odom_x_m"), number("odom_y_m"), number("odom_yaw_rad");
  if (is_usable(output)) {
    output.utime_anchor_us = table.integer(row, table.column(kAnchorColumn));
    output.pose = read_vector(table, row, kPoseColumns);
    output.covariance = read_symmetric(table, row, kPoseCovarianceColumns);
    output.twist = read_vector(table, row, kTwistColumns);
    output.twist_covariance = read_symmetric(table, row, kTwistCovarianceColumns);
  }
  return output;
}

}  // namespace

bool holds_states(const CsvTable& table) { return table.has_column(kAnchorColumn); }

RecordedStates read_states(const CsvTable& table) {
  std::vector<Odometry> outputs;
  std::vector<RowTime> times;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    outputs.push_back(read_output(table, row));
    times.push_back({outputs.back().utime_us, is_usable(outputs.back())});
  }
  RecordedStates result = recorded_states(outputs);
  result.odometry.availability = availability(times, time_of(table));
  return result;
}

RecordedStates recorded_states(const std::vector<Odometry>& outputs) {
  RecordedStates result;
  RecordedOdometry& odometry = result.odometry;
  std::optional<Pose2> before;
  std::int64_t before_us = 0;
  for (const Odometry& output : outputs) {
    const Eigen::Vector3d& since_start = output.odom_pose;
    if (output.status != OdometryStatus::initialising && std::isfinite(since_start.x())) {
      const Pose2 pose{since_start.x(), since_start.y(), since_start.z()};
      if (before && output.utime_us > before_us) {
        odometry.steps_since_start.push_back(
            {before_us, output.utime_us, motion_between(*before, pose), Eigen::Matrix3d::Zero()});
      }
      before = pose;
      before_us = output.utime_us;
    }
    if (!is_usable(output)) {
      ++odometry.without_estimate;
      continue;
    }
    result.states.push_back(output);
    if (output.utime_us > output.utime_anchor_us) {
      odometry.estimates.push_back(
          {output.utime_anchor_us, output.utime_us, output.pose, output.covariance});
    }
  }
  return result;
}

}  // namespace cremed
