// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// Faults of one radar whose bus carries frames.
std::vector<Finding> diagnose_radar(const Configuration& configuration,
                                    const Observation& observation, std::size_t radar);

/// Finding that the radar is on another bus; empty if it is not.
std::vector<Finding> find_elsewhere(const Configuration& configuration,
                                    const Observation& observation,
                                    const RadarConfiguration& wanted);

/// Finding that it sent no scans for much of the time.
bool fell_silent(const RadarObservation& observed, double seconds);

}  // namespace cremed
