// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/ars408_search.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include "daemon/message_text.hpp"
#include "tools/doctor/seen_radar.hpp"

namespace cremed {
namespace {

bool is_of_other_radar(std::uint8_t sensor_id, const Configuration& configuration,
                       const RadarConfiguration& radar) {
  return std::any_of(configuration.radars.begin(), configuration.radars.end(),
                     [&](const RadarConfiguration& other) {
                       const auto* options = std::get_if<Ars408Options>(&other.decoder);
                       return options != nullptr && other.name != radar.name &&
                              other.interface == radar.interface && options->sensor_id == sensor_id;
                     });
}

bool has_gpr(const BusObservation& bus) {
  const std::vector<SeenRadar> radars = seen_radars(bus);
  return std::any_of(radars.begin(), radars.end(),
                     [](const SeenRadar& seen) { return seen.kind == SeenRadar::Kind::bosch_gpr; });
}

Ars408Search choose(const std::vector<std::uint8_t>& candidates, const std::string& interface) {
  if (candidates.size() == 1) {
    return {candidates.front(), ""};
  }
  if (candidates.empty()) {
    return {std::nullopt, concat({"no 0x201 of an ARS408 on ", interface,
                                  "; check its power and cable, and run cremed-doctor without "
                                  "--configure-ars408"})};
  }
  std::string ids;
  for (const std::uint8_t id : candidates) {
    ids += concat({ids.empty() ? "" : ", ", std::to_string(id)});
  }
  return {std::nullopt, concat({"ARS408s with sensor ids ", ids, " are on ", interface,
                                ", none with the configured one; unplug all but the one meant"})};
}

}  // namespace

void note_state(const CanFrame& frame, Ars408States& states) {
  constexpr std::uint32_t kSensorBits = 0x70;
  constexpr auto kRadarState = static_cast<std::uint32_t>(Ars408Message::radar_state);
  if (!frame.is_classic_data() || (frame.id & ~kSensorBits) != kRadarState) {
    return;
  }
  const std::size_t sensor = (frame.id & kSensorBits) >> 4U;
  const auto state = decode_ars408_radar_state(std::span(frame.data).first(frame.length));
  if (state && state->sensor_id == sensor) {
    states[sensor] = state;
  }
}

Ars408Search find_ars408(const Configuration& configuration, const RadarConfiguration& radar,
                         const BusObservation& bus, const Ars408States& states) {
  if (has_gpr(bus)) {
    return {std::nullopt,
            concat({"a Bosch GPR is on ", radar.interface,
                    ", whose identifiers are those an ARS408 obeys; separate the two"})};
  }
  const std::uint8_t configured = std::get<Ars408Options>(radar.decoder).sensor_id;
  if (states[configured]) {
    return {configured, ""};
  }
  std::vector<std::uint8_t> candidates;
  for (std::size_t sensor = 0; sensor < states.size(); ++sensor) {
    const auto id = static_cast<std::uint8_t>(sensor);
    if (states[sensor] && !is_of_other_radar(id, configuration, radar)) {
      candidates.push_back(id);
    }
  }
  return choose(candidates, radar.interface);
}

}  // namespace cremed
