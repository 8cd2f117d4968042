// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// What the radar sends or obeys.
IdSet used_ids(const RadarConfiguration& radar);

/// What the radars on an interface send, in ascending order.
std::vector<std::uint32_t> ids_on(const std::string& interface,
                                  const std::vector<RadarConfiguration>& radars);

}  // namespace cremed
