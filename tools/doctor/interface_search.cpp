// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/interface_search.hpp"

#include <algorithm>
#include <ctime>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/source/radar_search.hpp"
#include "tools/doctor/merged_logs.hpp"
#include "tools/doctor/observer.hpp"
#include "tools/doctor/unconfigured.hpp"

namespace cremed {
namespace {

/// Two rounds of the search: the second sees every radar that is present.
constexpr std::int64_t kListenUs = 3'000'000;

Finding finding_of(const RadarConfiguration& radar, const std::vector<RadarPlace>& places,
                   std::size_t index) {
  const auto place = std::ranges::find(places, index, &RadarPlace::radar);
  return place == places.end()
             ? Finding{Severity::error,
                       concat({radar.name, ": its interface was not searched for"}),
                       "do not interrupt the doctor"}
             : Finding{Severity::error, concat({radar.name, ": ", place->problem}), place->remedy};
}

/// `found`: the configuration with the interfaces found.
LocatedRadars located(const Configuration& found, const std::vector<RadarPlace>& places) {
  LocatedRadars result{found, {}};
  std::vector<RadarConfiguration>& radars = result.configuration.radars;
  for (std::size_t i = 0; i < radars.size(); ++i) {
    if (is_auto(radars[i])) {
      result.findings.push_back(finding_of(radars[i], places, i));
    }
  }
  std::erase_if(radars, is_auto);
  result.configuration.odometry.enabled = found.odometry.enabled && !radars.empty();
  return result;
}

std::vector<HeardBus> heard_in(const std::vector<std::string>& paths) {
  Observer observer(without_radars());
  MergedLogs logs(paths);
  while (const CandumpLine* line = logs.next()) {
    if (line->status == CandumpStatus::frame) {
      observer.add(line->interface_name, line->frame);
    }
  }
  std::vector<HeardBus> buses;
  const Observation heard = observer.finish();
  for (const BusObservation& bus : heard.buses) {
    buses.push_back({bus.interface, bus.traffic});
  }
  return buses;
}

}  // namespace

LocatedRadars locate_live(const Configuration& configuration,
                          const volatile std::sig_atomic_t* stop) {
  constexpr timespec kPause{0, 10'000'000};
  RadarSearch search(configuration);
  LinkWatch links;
  std::vector<RadarPlace> places;
  const std::int64_t end_us = monotonic_us() + kListenUs;
  while (!search.is_over() && *stop == 0 && monotonic_us() < end_us) {
    links.update();
    for (const RadarPlace& place : search.listen(links, monotonic_us())) {
      std::erase_if(places, [&](const RadarPlace& old) { return old.radar == place.radar; });
      places.push_back(place);
    }
    ::nanosleep(&kPause, nullptr);
  }
  return located(search.configuration(), places);
}

LocatedRadars locate_in_logs(const Configuration& configuration,
                             const std::vector<std::string>& paths) {
  if (has_interface_names(configuration)) {
    return {configuration, {}};
  }
  if (std::ranges::count(paths, "-") != 0) {
    require_interface_names(configuration);
  }
  Configuration found = configuration;
  const std::vector<RadarPlace> places = find_interfaces(heard_in(paths), found);
  return located(found, places);
}

}  // namespace cremed
