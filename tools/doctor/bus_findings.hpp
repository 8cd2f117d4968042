// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/report/finding.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// No frame came from this bus.
bool is_silent(const BusObservation& bus);

/// Faults of one bus, independent of its radars.
std::vector<Finding> bus_findings(const BusObservation& bus, const Observation& observation);

}  // namespace cremed
