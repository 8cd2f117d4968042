// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/configuration/radar_place.hpp"

#include <algorithm>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"

namespace cremed {
namespace {

bool shows(const HeardBus& bus, const RadarSettings& wanted) {
  const std::vector<RadarSettings> radars = seen_radars(bus.traffic);
  return std::ranges::any_of(
      radars, [&](const RadarSettings& radar) { return radar.is_same_radar(wanted); });
}

/// "can0: a Bosch GPR with base id 0x200; can1: no radar"
std::string heard_text(const std::vector<HeardBus>& buses, const RadarSettings& wanted) {
  const auto description = [&](const RadarSettings& radar) { return radar.describe_to(wanted); };
  const auto text = [&](const HeardBus& bus) {
    const std::string radars = joined(seen_radars(bus.traffic), description);
    return concat({printable(bus.interface), ": ", radars.empty() ? "no radar" : radars});
  };
  return buses.empty() ? "no CAN interface is up" : joined(buses, text, "; ");
}

/// Checks a known interface for clashes with other radars.
RadarPlace checked(std::size_t radar, const Configuration& configuration,
                   const std::string& interface) {
  const RadarConfiguration& wanted = configuration.radars[radar];
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    const RadarConfiguration& other = configuration.radars[i];
    const IdSet shared = used_ids(wanted) & used_ids(other);
    if (i != radar && other.interface == interface && shared.any()) {
      return {radar, PlaceStatus::clash, "",
              concat({wanted.decoder.describe(), " is on ", interface, ", where radar ",
                      in_quotes(other.name), " uses CAN identifier ",
                      hexadecimal(shared._Find_first()), " as well"}),
              "give one of them another bus, or other identifiers"};
    }
  }
  return {radar, PlaceStatus::found, interface, "", ""};
}

RadarPlace place_of(std::size_t radar, const Configuration& configuration,
                    const std::vector<HeardBus>& buses) {
  const RadarConfiguration& wanted = configuration.radars[radar];
  std::vector<std::string> names;
  for (const HeardBus& bus : buses) {
    if (shows(bus, wanted.decoder)) {
      names.push_back(bus.interface);
    }
  }
  if (names.empty()) {
    return {radar, PlaceStatus::absent, "",
            concat({"no CAN interface shows ", wanted.decoder.describe(), " (",
                    heard_text(buses, wanted.decoder), ")"}),
            "check its power and cable, and that its interface is up"};
  }
  if (names.size() > 1) {
    return {radar, PlaceStatus::ambiguous, "",
            concat({wanted.decoder.describe(), " is on ", joined(names, printable, " and on ")}),
            concat({"set interface to one of them for radar ", in_quotes(wanted.name)})};
  }
  return checked(radar, configuration, names.front());
}

}  // namespace

std::vector<RadarPlace> find_interfaces(const std::vector<HeardBus>& buses,
                                        Configuration& configuration) {
  std::vector<RadarPlace> places;
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    RadarConfiguration& radar = configuration.radars[i];
    if (is_auto(radar)) {
      const RadarPlace& place = places.emplace_back(place_of(i, configuration, buses));
      radar.interface = place.status == PlaceStatus::found ? place.interface : radar.interface;
    }
  }
  return places;
}

}  // namespace cremed
