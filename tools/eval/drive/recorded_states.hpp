// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "tools/eval/csv_table.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"

namespace cremed {

/// The vehicle's state as `cremed --output-odometry` writes it.
struct RecordedStates {
  std::vector<Odometry> states;  ///< Of each row that has an estimate.
  /// Each state's pose as a motion since its anchor; none for a state at its own anchor's time. The
  /// state at the time of a new anchor still refers to the old one, so that the anchors form a
  /// chain. Its steps since the start are those between all rows that have a pose and are no longer
  /// initialising.
  RecordedOdometry odometry{"odometry", {}, 0};
};

/// Whether the table's header is that of the vehicle's state.
bool holds_states(const CsvTable& table);

/// Throws std::runtime_error.
RecordedStates read_states(const CsvTable& table);

/// The same from the pipeline's outputs.
RecordedStates recorded_states(const std::vector<Odometry>& outputs);

}  // namespace cremed
