// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/radar_identifiers.hpp"

namespace cremed {
IdSet used_ids(const RadarConfiguration& radar) {
  return radar.decoder.sent_ids() | radar.decoder.obeyed_ids();
}

std::vector<std::uint32_t> ids_on(const std::string& interface,
                                  const std::vector<RadarConfiguration>& radars) {
  IdSet ids;
  for (const RadarConfiguration& radar : radars) {
    ids |= radar.interface == interface ? radar.decoder.sent_ids() : IdSet{};
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
