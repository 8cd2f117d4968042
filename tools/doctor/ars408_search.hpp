// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "can_decoders/ars408_messages.hpp"
#include "daemon/configuration.hpp"
#include "tools/doctor/bus_observation.hpp"

namespace cremed {

/// The latest 0x201 by sensor id.
using Ars408States = std::array<std::optional<Ars408RadarState>, 8>;

/// Notes the state in the frame, if it is a 0x201 of the sensor that it names itself.
void note_state(const CanFrame& frame, Ars408States& states);

/// Which sensor on the bus the radar of the configuration is.
struct Ars408Search {
  std::optional<std::uint8_t> sensor_id;  ///< The one it has now.
  std::string problem;                    ///< Why there is none.
};

/// The sensor with the configured id, else the only one that no radar of the configuration is. None
/// where a GPR is on the bus: what an ARS408 is told would be its targets.
Ars408Search find_ars408(const Configuration& configuration, const RadarConfiguration& radar,
                         const BusObservation& bus, const Ars408States& states);

}  // namespace cremed
