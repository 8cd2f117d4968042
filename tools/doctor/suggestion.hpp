// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cremed/can_decoders/radar_family.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/report/finding.hpp"
#include "tools/doctor/observation.hpp"

namespace cremed {

/// A first configuration of the radars recognised on the buses: name, type, interface, identifiers.
/// Mounts cannot be observed: the file is refused until they are filled in. Empty if no radar was
/// recognised.
std::string suggested_configuration(const Observation& observation,
                                    RadarFamilies families = radar_families());

/// What an ARS408 is examined for: what it should send, or what it does.
enum class ExaminedOutput : std::uint8_t { clusters, as_sent };

/// The same radars, to examine each without a mount: it is 0, and the motion free in all
/// directions. Without radars if none was recognised.
Configuration examined_configuration(const Observation& observation,
                                     ExaminedOutput output = ExaminedOutput::clusters);

/// A finding for each radar that shares an identifier with another of its bus: no configuration has
/// both.
std::vector<Finding> radars_left_out(const Observation& observation);

/// With that configuration: what may be wrong with the mount or the motion is no finding. A wrong
/// Doppler is one for any mount.
void drop_doubts_of_mounts(Observation& observation);

/// The traffic and advice if nothing can be suggested.
std::string no_suggestion(const Observation& observation);

}  // namespace cremed
