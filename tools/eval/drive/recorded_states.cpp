// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/recorded_states.hpp"

#include "tools/eval/csv_matrix.hpp"

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

}  // namespace

bool holds_states(const CsvTable& table) { return table.has_column(kAnchorColumn); }

RecordedStates read_states(const CsvTable& table) {
  const std::size_t status = table.column("status");
  RecordedStates result;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (is_estimate(table.text(row, status))) {
      result.states.push_back(read_state(table, row));
    } else {
      ++result.without_estimate;
    }
  }
  return result;
}

RecordedOdometry motions_since_anchors(const RecordedStates& states) {
  RecordedOdometry result{"odometry", {}, states.without_estimate};
  for (const RecordedState& state : states.states) {
    if (state.utime_us > state.anchor_us) {
      result.estimates.push_back({state.anchor_us, state.utime_us, state.pose, state.covariance});
    }
  }
  return result;
}

}  // namespace cremed
