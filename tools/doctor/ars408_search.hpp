// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "daemon/configuration/configuration.hpp"
#include "tools/doctor/bus_observation.hpp"

namespace cremed {

/// Observations of one sensor id from its 0x201.
struct Ars408Reports {
  std::optional<Ars408RadarState> state;  ///< The latest.
  bool is_changing = false;               ///< The settings changed between two of them.
  /// From the first to the last of three: of two, the first may have come late (by 0.5 s).
  std::optional<std::int64_t> shortest_three_us;
  std::int64_t stamp_us = 0;                    ///< Of the latest.
  std::optional<std::int64_t> stamp_before_us;  ///< Of the one before it.
};

/// By sensor id.
using Ars408States = std::array<Ars408Reports, 8>;

/// Notes the state in a frame that is the 0x201 of the sensor named in it.
void note_state(const CanFrame& frame, Ars408States& states);

/// Selects the sensor to talk to.
struct Ars408Address {
  /// The sensor's present id if the user gave one; otherwise the configured id.
  std::optional<std::uint8_t> said_id;
  /// A sensor sends 0x201 once a second, so three take 2 s; with a second sensor of its id, 1 s.
  std::int64_t shortest_three_us = 1'500'000;
};

/// Result of the search for the radar's sensor.
struct Ars408Search {
  std::optional<std::uint8_t> sensor_id;  ///< Its present id.
  std::string problem;                    ///< Why none was selected.
};

/// The wanted sensor, if it is present and the only one with its id. Never guesses: settings
/// outlast power-off. None on a bus with a GPR, whose targets use the identifiers of commands to an
/// ARS408.
Ars408Search find_ars408(const Configuration& configuration, const RadarConfiguration& radar,
                         const Ars408Address& address, const BusObservation& bus,
                         const Ars408States& states);

}  // namespace cremed
