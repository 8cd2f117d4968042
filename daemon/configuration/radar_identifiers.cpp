// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/radar_identifiers.hpp"

#include "daemon/configuration/interfaces.hpp"

namespace cremed {
namespace {

/// Identifiers that the radar sends; with motion_feedback also those that it obeys, since other
/// nodes may send them too.
IdSet heard_ids(const RadarConfiguration& radar) {
  return has_motion_feedback(radar) ? used_ids(radar) : radar.decoder.sent_ids();
}

}  // namespace

bool has_motion_feedback(const RadarConfiguration& radar) {
  const auto* ars408 = radar.decoder.as<Ars408Options>();
  return ars408 != nullptr && ars408->motion_feedback;
}

IdSet used_ids(const RadarConfiguration& radar) {
  return radar.decoder.sent_ids() | radar.decoder.obeyed_ids();
}

std::vector<std::uint32_t> ids_on(std::size_t interface, const Configuration& configuration) {
  IdSet ids;
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    const bool is_there = interface_index(configuration, i) == interface;
    ids |= is_there ? heard_ids(configuration.radars[i]) : IdSet{};
  }
  const VehicleConfiguration& vehicle = configuration.vehicle;
  if (!vehicle.interface.empty() && vehicle_interface_index(configuration) == interface) {
    for (const std::optional<std::uint32_t> id : vehicle.ids) {
      ids |= id ? IdSet().set(*id) : IdSet{};
    }
  }
  std::vector<std::uint32_t> list;
  for (std::uint32_t id = 0; id < ids.size(); ++id) {
    if (ids[id]) {
      list.push_back(id);
    }
  }
  return list;
}

}  // namespace cremed
