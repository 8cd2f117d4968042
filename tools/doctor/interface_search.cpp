// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/interface_search.hpp"

#include <algorithm>
#include <ctime>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/source/candump_reader.hpp"
#include "daemon/source/radar_search.hpp"
#include "tools/doctor/observer.hpp"
#include "tools/doctor/unconfigured.hpp"

namespace cremed {
namespace {

/// Two rounds of the search: the second sees every radar that is present.
constexpr std::int64_t kListenUs = 3'000'000;

Finding finding_of(const RadarConfiguration& radar, const std::vector<Sighting>& sightings,
                   std::size_t index) {
  const auto sighting = std::ranges::find(sightings, index, &Sighting::radar);
  return sighting == sightings.end()
             ? Finding{Severity::error,
                       concat({radar.name, ": its interface was not searched for"}),
                       "do not interrupt the doctor"}
             : Finding{Severity::error, concat({radar.name, ": ", sighting->place.problem}),
                       sighting->place.remedy};
}

/// `found`: the configuration with the interfaces found.
LocatedRadars located(const Configuration& found, const std::vector<Sighting>& sightings) {
  LocatedRadars result{found, {}};
  std::vector<RadarConfiguration>& radars = result.configuration.radars;
  for (std::size_t i = 0; i < radars.size(); ++i) {
    if (is_auto(radars[i])) {
      result.findings.push_back(finding_of(radars[i], sightings, i));
    }
  }
  std::erase_if(radars, is_auto);
  result.configuration.odometry.enabled = found.odometry.enabled && !radars.empty();
  return result;
}

std::vector<HeardBus> heard_in(const std::string& path) {
  Observer observer(without_radars());
  CandumpReader log(path);
  for (CandumpLine line; log.next(line);) {
    if (line.status == CandumpStatus::frame) {
      observer.add(line.interface_name, line.frame);
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
  std::vector<Sighting> sightings;
  const std::int64_t end_us = monotonic_us() + kListenUs;
  while (!search.is_over() && *stop == 0 && monotonic_us() < end_us) {
    links.update();
    for (const Sighting& sighting : search.listen(links, monotonic_us())) {
      std::erase_if(sightings, [&](const Sighting& old) { return old.radar == sighting.radar; });
      sightings.push_back(sighting);
    }
    ::nanosleep(&kPause, nullptr);
  }
  return located(search.configuration(), sightings);
}

LocatedRadars locate_in_log(const Configuration& configuration, const std::string& path) {
  if (has_interface_names(configuration)) {
    return {configuration, {}};
  }
  if (path == "-") {
    require_interface_names(configuration);
  }
  Configuration found = configuration;
  const std::vector<Sighting> sightings = find_interfaces(heard_in(path), found);
  return located(found, sightings);
}

}  // namespace cremed
