// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/interface_search.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "daemon/configuration/interfaces.hpp"
#include "daemon/process/clocks.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/source/candump.hpp"
#include "daemon/source/line_reader.hpp"
#include "daemon/source/radar_search.hpp"
#include "tools/doctor/observer.hpp"

namespace cremed {
namespace {

/// Two rounds of the search: a radar that is there is seen in the second at the latest.
constexpr std::int64_t kListenUs = 3'000'000;

bool is_named(const Configuration& configuration) {
  const auto& radars = configuration.radars;
  return std::none_of(radars.begin(), radars.end(), is_auto);
}

Finding finding_of(const RadarConfiguration& radar, const std::vector<Sighting>& sightings,
                   std::size_t index) {
  const auto sighting = std::find_if(sightings.begin(), sightings.end(),
                                     [&](const Sighting& s) { return s.radar == index; });
  return sighting == sightings.end()
             ? Finding{Severity::error, concat({radar.name, ": its interface was not looked for"}),
                       "let the doctor listen to its end"}
             : Finding{Severity::error, concat({radar.name, ": ", sighting->place.problem}),
                       sighting->place.remedy};
}

/// `found`: the configuration with the interfaces that were found.
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

void hear(std::string_view line, std::vector<HeardBus>& buses) {
  const CandumpLine parsed = parse_candump_line(line);
  if (parsed.status != CandumpStatus::frame) {
    return;
  }
  auto bus = std::find_if(buses.begin(), buses.end(), [&](const HeardBus& known) {
    return known.interface == parsed.interface_name;
  });
  if (bus == buses.end()) {
    if (buses.size() >= kMostBuses) {
      return;
    }
    bus = buses.emplace(buses.end());
    bus->interface = parsed.interface_name;
  }
  bus->traffic.add(parsed.frame);
}

std::vector<HeardBus> heard_in(const std::string& path) {
  std::vector<HeardBus> buses;
  LineReader reader(path);
  std::string_view line;
  for (auto status = reader.next(line); status != LineReader::Status::end;
       status = reader.next(line)) {
    if (status == LineReader::Status::failed) {
      throw std::runtime_error(concat({path, ": ", std::strerror(errno)}));
    }
    if (status == LineReader::Status::line) {
      hear(line, buses);
    }
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
  if (is_named(configuration)) {
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
