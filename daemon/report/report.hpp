// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/output/radar_status.hpp"
#include "daemon/report/finding.hpp"

namespace cremed {

/// Number of estimates so far.
std::uint64_t estimates(const RadarStatus& status);

/// One line: scans, estimates, what kept the others out.
std::string summary(const RadarStatus& status);

/// One line: every counter of bad frames and imperfect scans that is not zero; empty if all are.
std::string irregularities(const RadarStatus& status);

/// Why there is no odometry, or bad odometry, as far as the pipeline can tell; most likely cause
/// first.
std::vector<Finding> radar_findings(const RadarConfiguration& radar, const RadarStatus& status);

/// What the sensor says about itself, and about how it is set.
std::vector<Finding> health_findings(const RadarConfiguration& radar, const RadarStatus& status);

}  // namespace cremed
