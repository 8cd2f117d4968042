// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/interfaces.hpp"

#include <algorithm>

namespace cremed {

std::vector<std::string> interface_names(const Configuration& configuration) {
  std::vector<std::string> names;
  for (const RadarConfiguration& radar : configuration.radars) {
    if (std::find(names.begin(), names.end(), radar.interface) == names.end()) {
      names.push_back(radar.interface);
    }
  }
  return names;
}

std::uint8_t interface_index(const Configuration& configuration, const RadarConfiguration& radar) {
  const std::vector<std::string> names = interface_names(configuration);
  const auto name = std::find(names.begin(), names.end(), radar.interface);
  return static_cast<std::uint8_t>(name - names.begin());
}

}  // namespace cremed
