// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/toml_reader.hpp"

namespace cremed {

/// Whether the text can be the name of a CAN interface.
bool is_interface_name(std::string_view text);

/// Whether sources of these names would have one LCM channel: channels are in upper case.
bool share_channel(std::string_view a, std::string_view b);

/// A radar and its place in the file.
struct PlacedRadar {
  RadarConfiguration radar;
  std::size_t name_line = 0;
  std::size_t interface_line = 0;
};

/// Reads one [[radar]] table; `defaults` are those of [estimator], `families` the allowed types.
PlacedRadar read_radar(TomlReader reader, const EgoMotionOptions& defaults, RadarFamilies families);

/// Reads [calibrated]: its own key replaces that of [odometry]; its tables have the names of radars
/// and replace [radar.mount] and [radar.calibration].
void read_calibrated(TomlReader reader, std::vector<PlacedRadar>& radars,
                     OdometryConfiguration& odometry);

/// Reports radars with the same name, and radars on one interface that share identifiers.
void check_radars(const std::vector<PlacedRadar>& radars, Diagnostics& diagnostics);

}  // namespace cremed
