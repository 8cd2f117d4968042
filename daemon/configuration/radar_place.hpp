// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cremed/can_decoders/bus_traffic.hpp"
#include "daemon/configuration/configuration.hpp"

namespace cremed {

/// A CAN interface and its traffic.
struct HeardBus {
  std::string interface;
  BusTraffic traffic;
};

enum class PlaceStatus : std::uint8_t {
  found,
  absent,     ///< No interface shows this radar.
  ambiguous,  ///< Several interfaces show it.
  /// Its interface is found, but another radar of the configuration uses the same identifiers
  /// there.
  clash,
};

/// Result of the search for one radar's interface.
struct RadarPlace {
  std::size_t radar = 0;  ///< Index in the configuration.
  PlaceStatus status = PlaceStatus::absent;
  std::string interface;  ///< If found.
  std::string problem;    ///< If not.
  std::string remedy;
};

/// Finds the interfaces of the radars with "auto" from the traffic, and writes them into the
/// configuration.
std::vector<RadarPlace> find_interfaces(const std::vector<HeardBus>& buses,
                                        Configuration& configuration);

}  // namespace cremed
