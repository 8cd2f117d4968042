// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/toml_reader.hpp"

namespace cremed {

/// Reads the one key of [odometry] that calibration finds.
void read_slip_per_lateral_acceleration(TomlReader& reader, OdometryConfiguration& odometry);

/// Reads [odometry]; absent keys keep the values in `odometry`.
void read_odometry(TomlReader reader, OdometryConfiguration& odometry);

}  // namespace cremed
