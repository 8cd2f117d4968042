// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "daemon/configuration_radar.hpp"
#include "daemon/message_text.hpp"

namespace cremed {
namespace {

/// Standard CAN identifiers.
using IdSet = std::bitset<0x800>;

/// Everything an ARS408 sends or obeys, because a foreign frame on any of these does harm: as a
/// target that is none, or as a new setting of the sensor. 0x008 and 0x010 (relay) do neither.
constexpr std::uint32_t kArs408Ids[] = {0x200, 0x201, 0x202, 0x203, 0x204, 0x300, 0x301,
                                        0x400, 0x401, 0x402, 0x408, 0x600, 0x60A, 0x60B,
                                        0x60C, 0x60D, 0x60E, 0x700, 0x701, 0x702};

IdSet ids_of(const Ars408Options& options) {
  IdSet ids;
  for (const std::uint32_t id : kArs408Ids) {
    ids.set(id + 0x10U * options.sensor_id);
  }
  return ids;
}

IdSet ids_of(const BoschGprOptions& options) {
  IdSet ids;
  ids.set(options.info_id);
  for (std::uint32_t i = 0; i < kGprTargetIds; ++i) {
    ids.set(options.base_id + i);
  }
  return ids;
}

IdSet ids_of(const RadarConfiguration& radar) {
  return std::visit([](const auto& options) { return ids_of(options); }, radar.decoder);
}

std::string upper_case(std::string text) {
  for (char& c : text) {
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return text;
}

std::string of_radar(const PlacedRadar& placed) {
  return concat(
      {" of radar \"", placed.radar.name, "\" (line ", std::to_string(placed.name_line), ")"});
}

/// Channel names are in capitals, so names that differ in case only would share one.
void check_name(const PlacedRadar& earlier, const PlacedRadar& later, Diagnostics& diagnostics) {
  if (upper_case(earlier.radar.name) == upper_case(later.radar.name)) {
    diagnostics.add(later.name_line, "radar.name",
                    concat({"is the name", of_radar(earlier), "; must differ in more than case"}));
  }
}

void check_ids(const PlacedRadar& earlier, const PlacedRadar& later, Diagnostics& diagnostics) {
  const IdSet shared = ids_of(earlier.radar) & ids_of(later.radar);
  if (earlier.radar.interface == later.radar.interface && shared.any()) {
    diagnostics.add(later.interface_line, "radar.interface",
                    concat({"is the interface", of_radar(earlier), ", and both use CAN identifier ",
                            hexadecimal(shared._Find_first()),
                            "; must be another interface, or have other identifiers"}));
  }
}

}  // namespace

void check_radars(const std::vector<PlacedRadar>& radars, Diagnostics& diagnostics) {
  for (std::size_t later = 0; later < radars.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      check_name(radars[earlier], radars[later], diagnostics);
      check_ids(radars[earlier], radars[later], diagnostics);
    }
  }
}

}  // namespace cremed
