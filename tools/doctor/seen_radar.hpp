// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "tools/doctor/bus_observation.hpp"

namespace cremed {

/// A radar that the identifiers and lengths on a bus give away, configured or not.
struct SeenRadar {
  enum class Kind : std::uint8_t { ars408, bosch_gpr };
  Kind kind = Kind::ars408;
  std::uint32_t number = 0;  ///< Sensor id, or base id of a GPR.

  bool operator==(const SeenRadar&) const = default;
};

/// Those of a GPR come as 96 consecutive identifiers; what is left may be of ARS408s.
std::vector<SeenRadar> seen_radars(const BusObservation& bus);

/// The radar that the configuration expects.
SeenRadar expected_radar(const RadarConfiguration& radar);

/// "an ARS408 with sensor id 3", "a Bosch GPR with base id 0x200"
std::string to_text(const SeenRadar& radar);

/// The key to set where this radar is to be used: "sensor_id = 3".
std::string key_of(const SeenRadar& radar);

/// The first identifiers on a bus, and what else is on it: "0x123, 0x124".
std::string seen_ids(const BusObservation& bus);

}  // namespace cremed
