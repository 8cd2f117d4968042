// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// Distinct names of the radars' interfaces, in order of first mention.
std::vector<std::string> interface_names(const Configuration& configuration);

/// CanFrame::interface of a radar of the configuration: where its interface is in that list.
std::uint8_t interface_index(const Configuration& configuration, const RadarConfiguration& radar);

}  // namespace cremed
