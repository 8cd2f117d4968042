// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bitset>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// A GPR sends two messages for each of its 48 targets, always.
inline constexpr std::uint32_t kGprTargetIds = 2U * kBoschGprSlots;

/// Standard CAN identifiers.
using IdSet = std::bitset<0x800>;

/// What the radar sends.
IdSet sent_ids(const RadarConfiguration& radar);

/// What the radar sends or obeys.
IdSet used_ids(const RadarConfiguration& radar);

/// What the radars on an interface send, in ascending order.
std::vector<std::uint32_t> ids_on(const std::string& interface,
                                  const std::vector<RadarConfiguration>& radars);

}  // namespace cremed
