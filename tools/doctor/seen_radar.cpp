// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/seen_radar.hpp"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

constexpr std::uint32_t kSensors = 8;

/// First identifiers of runs as long as a GPR's; those in a run are taken out of `ids`.
std::vector<SeenRadar> take_gprs(const BusObservation& bus, IdSet& ids) {
  std::vector<SeenRadar> radars;
  std::size_t run = 0;
  for (std::size_t id = 0; id < bus.ids.size(); ++id) {
    run = bus.ids[id].frames != 0 && bus.ids[id].length == 8 ? run + 1 : 0;
    if (run == kGprTargetIds) {
      const std::size_t base = id + 1 - kGprTargetIds;
      radars.push_back({SeenRadar::Kind::bosch_gpr, static_cast<std::uint32_t>(base)});
      for (std::size_t taken = base; taken <= id; ++taken) {
        ids.reset(taken);
      }
      run = 0;
    }
  }
  return radars;
}

bool has(const BusObservation& bus, const IdSet& ids, Ars408Message message, std::uint32_t sensor,
         std::uint8_t length) {
  const std::uint32_t id = ars408_id(static_cast<std::uint32_t>(message), sensor);
  return ids[id] && bus.ids[id].length == length;
}

/// A GPR of which a frame is lost may have the identifier too.
bool has_state(const BusObservation& bus, const IdSet& ids, std::uint32_t sensor) {
  const auto message = static_cast<std::uint32_t>(Ars408Message::radar_state);
  return has(bus, ids, Ars408Message::radar_state, sensor, 8) &&
         bus.ars408_states[sensor] == bus.ids[ars408_id(message, sensor)].frames;
}

/// Any message that comes once a cycle or second shows an ARS408; its length tells it from others.
bool has_ars408(const BusObservation& bus, const IdSet& ids, std::uint32_t sensor) {
  return has_state(bus, ids, sensor) || has(bus, ids, Ars408Message::cluster_status, sensor, 5) ||
         has(bus, ids, Ars408Message::object_status, sensor, 4);
}

}  // namespace

std::vector<SeenRadar> seen_radars(const BusObservation& bus) {
  IdSet ids;
  for (std::size_t id = 0; id < bus.ids.size(); ++id) {
    ids[id] = bus.ids[id].frames != 0;
  }
  std::vector<SeenRadar> radars = take_gprs(bus, ids);
  for (std::uint32_t sensor = 0; sensor < kSensors; ++sensor) {
    if (has_ars408(bus, ids, sensor)) {
      radars.push_back({SeenRadar::Kind::ars408, sensor});
    }
  }
  return radars;
}

SeenRadar expected_radar(const RadarConfiguration& radar) {
  if (const auto* ars408 = std::get_if<Ars408Options>(&radar.decoder)) {
    return {SeenRadar::Kind::ars408, ars408->sensor_id};
  }
  return {SeenRadar::Kind::bosch_gpr, std::get<BoschGprOptions>(radar.decoder).base_id};
}

std::string to_text(const SeenRadar& radar) {
  return radar.kind == SeenRadar::Kind::ars408
             ? concat({"an ARS408 with sensor id ", std::to_string(radar.number)})
             : concat({"a Bosch GPR with base id ", hexadecimal(radar.number)});
}

std::string key_of(const SeenRadar& radar) {
  return radar.kind == SeenRadar::Kind::ars408
             ? concat({"sensor_id = ", std::to_string(radar.number)})
             : concat({"base_id = ", hexadecimal(radar.number)});
}

std::string seen_ids(const BusObservation& bus) {
  constexpr std::size_t kMaxNamed = 8;
  std::string text;
  std::size_t count = 0;
  for (std::size_t id = 0; id < bus.ids.size(); ++id) {
    if (bus.ids[id].frames != 0 && ++count <= kMaxNamed) {
      text += concat({count == 1 ? "" : ", ", hexadecimal(id)});
    }
  }
  text += count > kMaxNamed ? concat({" and ", std::to_string(count - kMaxNamed), " more"}) : "";
  if (bus.foreign_frames != 0) {
    text += concat({text.empty() ? "" : ", ", std::to_string(bus.foreign_frames),
                    " extended, remote or FD frames"});
  }
  return text;
}

}  // namespace cremed
