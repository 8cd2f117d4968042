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

/// What the 0x201 of one sensor id tell.
struct Ars408Reports {
  std::optional<Ars408RadarState> state;        ///< The latest.
  bool is_changing = false;                     ///< Two of them say that it is set otherwise.
  std::optional<std::int64_t> shortest_gap_us;  ///< Between two of them.
  std::int64_t stamp_us = 0;                    ///< Of the latest.
};

/// By sensor id.
using Ars408States = std::array<Ars408Reports, 8>;

/// Notes the state in the frame, if it is a 0x201 of the sensor that it names itself.
void note_state(const CanFrame& frame, Ars408States& states);

/// Which sensor a frame is meant for.
struct Ars408Address {
  /// The id the sensor has now, in the user's own words; else it has to be the configured one.
  std::optional<std::uint8_t> said_id;
  /// A sensor reports once a second: two of one id come closer together, at least once.
  std::int64_t shortest_gap_us = 750'000;
};

/// Which sensor on the bus the radar of the configuration is.
struct Ars408Search {
  std::optional<std::uint8_t> sensor_id;  ///< The one it has now.
  std::string problem;                    ///< Why there is none.
};

/// The sensor that is meant, if it is there, and the only one with its id. None is guessed: what is
/// set in a wrong one outlasts power-off. None where a GPR is on the bus: what an ARS408 is told
/// would be its targets.
Ars408Search find_ars408(const Configuration& configuration, const RadarConfiguration& radar,
                         const Ars408Address& address, const BusObservation& bus,
                         const Ars408States& states);

}  // namespace cremed
