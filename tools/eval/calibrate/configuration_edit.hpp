// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/eval/calibrate/calibration_keys.hpp"

namespace cremed {

/// The text of a valid configuration with other values, `radars[i]` for the i-th [[radar]]; all
/// else stays byte by byte. A value that is there is replaced where it takes effect: in
/// [calibrated.NAME] or in the radar's inline table, sub-table or dotted keys. One that is not gets
/// a line in the table that it belongs to, in place of the commented-out default if there is one.
/// Throws std::runtime_error if what comes out does not read as wanted.
std::string edited_configuration(std::string_view text,
                                 const std::vector<std::vector<CalibratedValue>>& radars);

}  // namespace cremed
