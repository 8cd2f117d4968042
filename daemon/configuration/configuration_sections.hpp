// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/toml_reader.hpp"

// The readers of single sections. Absent keys keep the values.
namespace cremed {

/// [estimator] or [radar.estimator].
void read_estimator(TomlReader reader, EgoMotionOptions& options);

/// [odometry].
void read_odometry(TomlReader reader, OdometryConfiguration& odometry);

/// The one key of [odometry] that calibration finds.
void read_slip_per_lateral_acceleration(TomlReader& reader, OdometryConfiguration& odometry);

/// [vehicle].
void read_vehicle(TomlReader& reader, VehicleConfiguration& vehicle, VehicleOptions& options);

/// Reports what in the configuration contradicts [vehicle].
void check_vehicle(TomlReader& reader, const Configuration& configuration);

}  // namespace cremed
