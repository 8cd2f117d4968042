// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <utility>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/radar_family.hpp"

namespace cremed {

RadarFamilies radar_families() {
  static const std::array kFamilies{
      &family_of(BoschGprOptions{}),
      &family_of(Ars408Options{}),
      &family_of(Ars408Options{.model = Ars408Model::ars404_21}),
  };
  return kFamilies;
}

std::vector<RadarSettings> seen_radars(const BusTraffic& bus, RadarFamilies families) {
  IdSet unexplained = bus.seen();
  std::vector<RadarSettings> radars;
  for (const RadarFamily* family : families) {
    if (family->recognise == nullptr) {
      continue;
    }
    for (RadarSettings& radar : family->recognise(bus, unexplained)) {
      radars.push_back(std::move(radar));
    }
  }
  return radars;
}

}  // namespace cremed
