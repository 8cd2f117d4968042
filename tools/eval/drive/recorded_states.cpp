// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/recorded_states.hpp"

#include <cmath>
#include <optional>
#include <string>

#include "tools/eval/csv_table.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {
namespace {

constexpr const char* kAnchorColumn = "utime_anchor";
constexpr VectorColumns kTwistColumns{"vx_mps", "vy_mps", "yaw_rate_radps"};
constexpr SymmetricColumns kTwistCovarianceColumns{"cov_vxvx", "cov_vxvy", "cov_vxw",
                                                   "cov_vyvy", "cov_vyw",  "cov_ww"};

RecordedState read_state(const CsvTable& table, std::size_t row) {
  return {table.integer(row, table.column("utime")),
          table.integer(row, table.column(kAnchorColumn)),
          read_vector(table, row, kPoseColumns),
          read_symmetric(table, row, kPoseCovarianceColumns),
          read_vector(table, row, kTwistColumns),
          read_symmetric(table, row, kTwistCovarianceColumns)};
}

/// Makes steps of poses.
class StepRecorder {
 public:
  explicit StepRecorder(std::vector<RecordedEstimate>& steps) : steps_(steps) {}

  void add(std::int64_t utime_us, const Pose2& pose) {
    if (before_ && utime_us > before_us_) {
      steps_.push_back(
          {before_us_, utime_us, motion_between(*before_, pose), Eigen::Matrix3d::Zero()});
    }
    before_ = pose;
    before_us_ = utime_us;
  }

 private:
  std::vector<RecordedEstimate>& steps_;
  std::optional<Pose2> before_;
  std::int64_t before_us_ = 0;
};

bool has_pose_since_start(std::string_view status, const Pose2& pose) {
  return status != to_string(OdometryStatus::initialising) && std::isfinite(pose.x_m);
}

}  // namespace

bool holds_states(const CsvTable& table) { return table.has_column(kAnchorColumn); }

RecordedStates read_states(const CsvTable& table) {
  const std::size_t status = table.column("status");
  const std::size_t x = table.column("odom_x_m");
  const std::size_t y = table.column("odom_y_m");
  const std::size_t yaw = table.column("odom_yaw_rad");
  RecordedStates result;
  StepRecorder steps(result.steps);
  std::vector<RowTime> times;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    times.push_back(
        {table.integer(row, table.column("utime")), is_estimate(table.text(row, status))});
    const Pose2 pose{table.number(row, x), table.number(row, y), table.number(row, yaw)};
    if (has_pose_since_start(table.text(row, status), pose)) {
      steps.add(times.back().utime_us, pose);
    }
    if (times.back().is_usable) {
      result.states.push_back(read_state(table, row));
    } else {
      ++result.without_estimate;
    }
  }
  result.availability = availability(times, time_of(table));
  return result;
}

RecordedStates recorded_states(const std::vector<Odometry>& outputs) {
  RecordedStates result;
  StepRecorder steps(result.steps);
  for (const Odometry& output : outputs) {
    const std::string_view status = to_string(output.status);
    const Eigen::Vector3d& since_start = output.odom_pose;
    const Pose2 pose{since_start.x(), since_start.y(), since_start.z()};
    if (has_pose_since_start(status, pose)) {
      steps.add(output.utime_us, pose);
    }
    if (is_estimate(std::string(status))) {
      result.states.push_back({output.utime_us, output.utime_anchor_us, output.pose,
                               output.covariance, output.twist, output.twist_covariance});
    } else {
      ++result.without_estimate;
    }
  }
  return result;
}

RecordedOdometry motions_since_anchors(const RecordedStates& states) {
  RecordedOdometry result{
      "odometry", {}, states.without_estimate, states.steps, states.availability};
  for (const RecordedState& state : states.states) {
    if (state.utime_us > state.anchor_us) {
      result.estimates.push_back({state.anchor_us, state.utime_us, state.pose, state.covariance});
    }
  }
  return result;
}

}  // namespace cremed
