// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/interfaces.hpp"

#include <algorithm>

#include "daemon/process/message_text.hpp"

namespace cremed {

Interfaces interfaces_of(const Configuration& configuration) {
  Interfaces interfaces;
  std::vector<std::string>& names = interfaces.names;
  for (const RadarConfiguration& radar : configuration.radars) {
    const auto known = is_auto(radar) ? names.end() : std::ranges::find(names, radar.interface);
    interfaces.of_radars.push_back(static_cast<std::uint8_t>(known - names.begin()));
    if (known == names.end()) {
      names.push_back(radar.interface);
    }
  }
  const std::string& vehicle = configuration.vehicle.interface;
  const auto known = std::ranges::find(names, vehicle);
  interfaces.of_vehicle = static_cast<std::uint8_t>(known - names.begin());
  if (!vehicle.empty() && known == names.end()) {
    names.push_back(vehicle);
  }
  return interfaces;
}

bool is_auto(const RadarConfiguration& radar) { return radar.interface == kAutoInterface; }

bool has_interface_names(const Configuration& configuration) {
  return std::ranges::none_of(configuration.radars, is_auto);
}

std::vector<std::string> interface_names(const Configuration& configuration) {
  return interfaces_of(configuration).names;
}

void require_interface_names(const Configuration& configuration) {
  for (const RadarConfiguration& radar : configuration.radars) {
    if (is_auto(radar)) {
      throw ConfigurationError(concat(
          {"radar ", in_quotes(radar.name), ": interface = \"auto\" is for live buses; must ",
           "be the name in the log (`cremed-doctor --replay LOG --suggest-config` tells which ",
           "radar is where)"}));
    }
  }
}

}  // namespace cremed
