// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Whether the radar is told speed and yaw rate by cremed.
bool has_motion_feedback(const RadarConfiguration& radar);

/// What the radar sends or obeys.
IdSet used_ids(const RadarConfiguration& radar);

/// What the radars on an interface and [vehicle] send, and with motion_feedback what a radar obeys;
/// `interface` is the index in Interfaces::names.
IdSet ids_on(std::size_t interface, const Configuration& configuration);

}  // namespace cremed
