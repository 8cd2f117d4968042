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

IdSet ids_on(std::size_t interface, const Configuration& configuration) {
  const Interfaces interfaces = interfaces_of(configuration);
  IdSet ids;
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    ids |= interfaces.of_radars[i] == interface ? heard_ids(configuration.radars[i]) : IdSet{};
  }
  const VehicleConfiguration& vehicle = configuration.vehicle;
  if (!vehicle.interface.empty() && interfaces.of_vehicle == interface) {
    for (const std::optional<std::uint32_t> id : vehicle.ids) {
      ids |= id ? IdSet().set(*id) : IdSet{};
    }
  }
  return ids;
}

}  // namespace cremed
