// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/eval/calibrate/calibration_keys.hpp"

namespace cremed {

/// The text of a valid configuration with other values, `radars[i]` for the i-th [[radar]] and
/// `vehicle` for [odometry]; all else is unchanged. An existing value is replaced where it takes
/// effect: in [calibrated.NAME] or in the radar's inline table, sub-table or dotted keys. A missing
/// one is added to its table, replacing the commented-out default if there is one. Throws
/// std::runtime_error if the result does not read as wanted.
std::string edited_configuration(std::string_view text,
                                 const std::vector<std::vector<CalibratedValue>>& radars,
                                 const std::vector<CalibratedValue>& vehicle = {});

}  // namespace cremed
