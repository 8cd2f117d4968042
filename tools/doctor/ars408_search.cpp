// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/ars408_search.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "cremed/can_decoders/ars408_signals.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

std::string text(std::uint8_t sensor_id) { return std::to_string(sensor_id); }

std::uint8_t configured_id(const RadarConfiguration& radar) {
  return radar.decoder.as<Ars408Options>()->sensor_id;
}

/// The other radar of the configuration with this id on the same bus; null if there is none.
const RadarConfiguration* other_radar(std::uint8_t sensor_id, const Configuration& configuration,
                                      const RadarConfiguration& radar) {
  for (const RadarConfiguration& other : configuration.radars) {
    const auto* options = other.decoder.as<Ars408Options>();
    if (options != nullptr && other.name != radar.name && other.interface == radar.interface &&
        options->sensor_id == sensor_id) {
      return &other;
    }
  }
  return nullptr;
}

bool has_gpr(const BusObservation& bus) {
  const std::vector<RadarSettings> radars = seen_radars(bus.traffic);
  return std::ranges::any_of(
      radars, [](const RadarSettings& seen) { return seen.as<BoschGprOptions>() != nullptr; });
}

bool is_set_alike(const Ars408RadarState& a, const Ars408RadarState& b) {
  return a.output_code == b.output_code && a.sends_quality == b.sends_quality &&
         a.sends_extended == b.sends_extended && a.max_distance_m == b.max_distance_m &&
         a.power_code == b.power_code && a.sort_code == b.sort_code &&
         a.rcs_threshold_code == b.rcs_threshold_code;
}

/// Ids on the bus that belong to no other radar of the configuration, as "3, 5".
std::string free_ids(const Configuration& configuration, const RadarConfiguration& radar,
                     const Ars408States& states) {
  std::string ids;
  for (std::size_t id = 0; id < states.size(); ++id) {
    const auto sensor_id = static_cast<std::uint8_t>(id);
    if (states[id].state && other_radar(sensor_id, configuration, radar) == nullptr) {
      ids += concat({ids.empty() ? "" : ", ", text(sensor_id)});
    }
  }
  return ids;
}

std::string absence(std::uint8_t wanted, const Configuration& configuration,
                    const RadarConfiguration& radar, const Ars408States& states) {
  const std::string ids = free_ids(configuration, radar, states);
  if (ids.empty()) {
    return concat({"no 0x201 of an ARS408 with sensor id ", text(wanted), " on ", radar.interface,
                   "; check its power and cable, and run cremed-doctor without other options"});
  }
  return concat({"no ARS408 with sensor id ", text(wanted), " on ", radar.interface, ", but with ",
                 ids, "; if that is ", in_quotes(radar.name), ", say so: --sensor-id ",
                 ids.substr(0, 1),
                 ids.size() > 1 ? " (unplug the others if you do not know which)" : ""});
}

bool is_twin(const Ars408Reports& reports, const Ars408Address& address) {
  return reports.is_changing ||
         (reports.shortest_three_us && *reports.shortest_three_us < address.shortest_three_us);
}

/// Why a sensor with this id must not be changed; empty if it may be.
std::string problem(std::uint8_t id, const Configuration& configuration,
                    const RadarConfiguration& radar, const Ars408Address& address,
                    const Ars408States& states) {
  const std::uint8_t configured = configured_id(radar);
  if (const auto* other = other_radar(id, configuration, radar)) {
    return concat({"sensor id ", text(id), " on ", radar.interface, " is radar ",
                   in_quotes(other->name), "; name that, or take another --sensor-id"});
  }
  if (!states[id].state) {
    return absence(id, configuration, radar, states);
  }
  if (id != configured && states[configured].state) {
    return concat({"sensor id ", text(configured), ", which it would get, is on ", radar.interface,
                   " too; unplug that sensor, or leave out --sensor-id"});
  }
  if (is_twin(states[id], address)) {
    return concat({"two sensors with id ", text(id), " seem to be on ", radar.interface,
                   " (0x201 comes too often, or contradicts itself); unplug all but one"});
  }
  return {};
}

}  // namespace

void note_state(const CanFrame& frame, Ars408States& states) {
  constexpr auto kRadarState = static_cast<std::uint32_t>(Ars408Message::radar_state);
  if (!frame.is_classic_data() || ars408_base_id(frame.id) != kRadarState) {
    return;
  }
  const std::size_t sensor = ars408_sensor_id(frame.id);
  const auto state = decode_ars408<Ars408RadarState>(std::span(frame.data).first(frame.length));
  if (!state || state->sensor_id != sensor) {
    return;
  }
  Ars408Reports& reports = states[sensor];
  if (reports.state) {
    if (reports.stamp_before_us && *reports.stamp_before_us <= frame.stamp_us) {
      const std::int64_t three_us = frame.stamp_us - *reports.stamp_before_us;
      reports.shortest_three_us = std::min(reports.shortest_three_us.value_or(three_us), three_us);
    }
    reports.stamp_before_us = reports.stamp_us;
    reports.is_changing = reports.is_changing || !is_set_alike(*reports.state, *state);
  }
  reports.state = state;
  reports.stamp_us = frame.stamp_us;
}

Ars408Search find_ars408(const Configuration& configuration, const RadarConfiguration& radar,
                         const Ars408Address& address, const BusObservation& bus,
                         const Ars408States& states) {
  if (has_gpr(bus)) {
    return {std::nullopt,
            concat({"a Bosch GPR is on ", radar.interface,
                    ", whose identifiers are those an ARS408 obeys; separate the two"})};
  }
  const std::uint8_t id = address.said_id.value_or(configured_id(radar));
  const std::string why_not = problem(id, configuration, radar, address, states);
  return {why_not.empty() ? std::optional(id) : std::nullopt, why_not};
}

}  // namespace cremed
