// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// What is wrong with one radar whose bus carries frames.
std::vector<Finding> diagnose_radar(const Configuration& configuration,
                                    const Observation& observation, std::size_t radar);

/// The radar was seen, but on another bus; empty if not.
std::vector<Finding> find_elsewhere(const Configuration& configuration,
                                    const Observation& observation, std::size_t radar);

/// It sent scans, but for much of the time none came.
bool fell_silent(const RadarObservation& observed, double seconds);

}  // namespace cremed
