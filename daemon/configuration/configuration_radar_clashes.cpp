// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <string>

#include "daemon/configuration/configuration_radar.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

std::string of_radar(const PlacedRadar& placed) {
  return concat(
      {" of radar \"", placed.radar.name, "\" (line ", std::to_string(placed.name_line), ")"});
}

void check_name(const PlacedRadar& earlier, const PlacedRadar& later, Diagnostics& diagnostics) {
  if (share_channel(earlier.radar.name, later.radar.name)) {
    diagnostics.add(later.name_line, "radar.name",
                    concat({"is the name", of_radar(earlier), "; must differ in more than case"}));
  }
}

/// " are both an ARS408 with sensor id 0", or the two if their types differ.
std::string alike_text(const RadarSettings& earlier, const RadarSettings& later) {
  return &earlier.family() == &later.family()
             ? concat({" are both ", later.describe()})
             : concat({" cannot be distinguished: ", earlier.describe(), ", ", later.describe()});
}

/// Radars with interface "auto" must be distinguishable by their identifiers.
void check_search(const PlacedRadar& earlier, const PlacedRadar& later, Diagnostics& diagnostics) {
  if (earlier.radar.decoder.is_same_radar(later.radar.decoder)) {
    diagnostics.add(
        is_auto(later.radar) ? later.interface_line : earlier.interface_line, "radar.interface",
        concat({"is \"auto\", but radars ", in_quotes(earlier.radar.name), " and ",
                in_quotes(later.radar.name), alike_text(earlier.radar.decoder, later.radar.decoder),
                "; must be the name of an interface for both"}));
  }
}

void check_ids(const PlacedRadar& earlier, const PlacedRadar& later, Diagnostics& diagnostics) {
  const IdSet shared = used_ids(earlier.radar) & used_ids(later.radar);
  if (is_auto(earlier.radar) || is_auto(later.radar)) {
    check_search(earlier, later, diagnostics);
  } else if (earlier.radar.interface == later.radar.interface && shared.any()) {
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
