// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Causes of missing or bad odometry: errors first; within a severity the most likely first.
std::vector<Finding> diagnose(const Configuration& configuration, const Observation& observation);

/// "error", "warning" or "note".
const char* severity_name(Severity severity);

/// True if there is no finding above a note.
bool is_well(const std::vector<Finding>& findings);

/// One line: "front: 13.6 scans/s, 40 estimates".
std::string vital_signs(const RadarConfiguration& radar, const RadarObservation& observation,
                        double seconds);

/// The diagnosis as one JSON object, for scripts.
std::string diagnosis_json(const Configuration& configuration, const Observation& observation,
                           const std::vector<Finding>& findings);

}  // namespace cremed
