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

/// A CAN interface and what came on it.
struct HeardBus {
  std::string interface;
  BusTraffic traffic;
};

enum class PlaceStatus : std::uint8_t {
  found,
  absent,     ///< No interface shows this radar.
  ambiguous,  ///< Several do.
  clash,      ///< One does, but there another radar of the configuration uses its identifiers.
};

/// Which interface a radar is on.
struct RadarPlace {
  PlaceStatus status = PlaceStatus::absent;
  std::string interface;  ///< If found.
  std::string problem;    ///< If not.
  std::string remedy;
};

/// Where a radar is, by its index in the configuration.
struct Sighting {
  std::size_t radar = 0;
  RadarPlace place;
};

/// Where the radars are whose interface is to be found, by what the buses show. Interfaces that are
/// found are written into the configuration.
std::vector<Sighting> find_interfaces(const std::vector<HeardBus>& buses,
                                      Configuration& configuration);

}  // namespace cremed
