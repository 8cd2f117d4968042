// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/radar_identifiers.hpp"

#include <variant>

namespace cremed {
namespace {

/// What an ARS408 obeys: a foreign frame on any of these is a new setting or a wrong motion for it.
/// 0x008 and 0x010 (relay) do no harm.
constexpr std::uint32_t kArs408Commands[] = {0x200, 0x202, 0x300, 0x301, 0x400, 0x401};

IdSet sent_by(const Ars408Options& options) {
  IdSet ids;
  for (const Ars408MessageRow& row : kArs408Messages) {
    ids.set(ars408_id(static_cast<std::uint32_t>(row.message), options.sensor_id));
  }
  return ids;
}

IdSet sent_by(const BoschGprOptions& options) {
  IdSet ids;
  ids.set(options.info_id);
  for (std::uint32_t i = 0; i < kGprTargetIds; ++i) {
    ids.set(options.base_id + i);
  }
  return ids;
}

}  // namespace

IdSet sent_ids(const RadarConfiguration& radar) {
  return std::visit([](const auto& options) { return sent_by(options); }, radar.decoder);
}

IdSet used_ids(const RadarConfiguration& radar) {
  IdSet ids = sent_ids(radar);
  if (const auto* ars408 = std::get_if<Ars408Options>(&radar.decoder)) {
    for (const std::uint32_t id : kArs408Commands) {
      ids.set(ars408_id(id, ars408->sensor_id));
    }
  }
  return ids;
}

std::vector<std::uint32_t> ids_on(const std::string& interface,
                                  const std::vector<RadarConfiguration>& radars) {
  IdSet ids;
  for (const RadarConfiguration& radar : radars) {
    ids |= radar.interface == interface ? sent_ids(radar) : IdSet{};
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
