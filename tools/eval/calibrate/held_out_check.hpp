// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/eval/calibrate/calibration_fit.hpp"

namespace cremed {

/// Which states of a radar are to be taken from the fit; the others stay as configured.
using ChangedStates = std::array<bool, kCalibrationStates>;

/// How well values fit parts of the drive in which they were not found: the drive is cut into
/// parts, and each is compared with the values of all others. Misfits are those of least squares,
/// in the same measurements; the vehicle's motion is free in each.
struct HeldOutCheck {
  double configured = 0.0;  ///< Misfit with the configured values.
  double found = 0.0;       ///< With those found elsewhere.
  bool is_better = true;    ///< By more than the scatter between the parts.
  /// By radar: whether those of this radar contribute to that.
  std::vector<bool> is_radar_better;
  bool is_slip_better = true;  ///< Whether the slip contributes, if it is to be changed.
};

inline constexpr std::size_t kHeldOutParts = 5;

/// `fit`: solved; `changed`: by radar; `configured_slip`: if the slip is to be changed, otherwise
/// it is free, as the motion is.
HeldOutCheck check_held_out(const CalibrationFit& fit, const std::vector<ChangedStates>& changed,
                            const std::optional<double>& configured_slip = {});

}  // namespace cremed
