// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "cremed/can_decoders/radar_family.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// A first configuration, from the radars that give themselves away on the buses: name, type,
/// interface, identifiers. No bus tells where a radar is mounted: until that is filled in, the file
/// is refused. Empty if no radar was seen.
std::string suggested_configuration(const Observation& observation,
                                    RadarFamilies families = radar_families());

/// What was seen where there is nothing to suggest, and what to do.
std::string no_suggestion(const Observation& observation);

}  // namespace cremed
