// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/toml_reader.hpp"

namespace cremed {

/// Reads [vehicle]; absent keys keep the values.
void read_vehicle(TomlReader& reader, VehicleConfiguration& vehicle, VehicleOptions& options);

/// Reports what in the configuration contradicts [vehicle].
void check_vehicle(TomlReader& reader, const Configuration& configuration);

}  // namespace cremed
