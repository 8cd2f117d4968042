// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/unconfigured.hpp"

#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "daemon/configuration/configuration_path.hpp"
#include "daemon/configuration/first_configuration.hpp"
#include "daemon/process/joined.hpp"
#include "daemon/process/message_text.hpp"
#include "tools/doctor/bus_findings.hpp"

namespace cremed {
namespace {

/// Notes: whether a radar should be on a bus is not known.
void add_silent_buses(const Observation& observation, std::vector<Finding>& findings) {
  for (const BusObservation& bus : observation.buses) {
    if (is_silent(bus)) {
      Finding why = bus_findings(bus, observation).front();
      why.severity = Severity::note;
      findings.push_back(std::move(why));
    }
  }
}

}  // namespace

Configuration without_radars() {
  Configuration nothing;
  nothing.odometry.enabled = false;
  return nothing;
}

bool is_unconfigured(const std::string& named) { return named.empty() && is_unwritten(); }

bool is_pipe(const std::string& log) {
  std::error_code error;
  return log == "-" || std::filesystem::is_fifo(log, error);
}

LocatedRadars examined_radars(const Observation& observation, ExaminedOutput output) {
  LocatedRadars examined{examined_configuration(observation, output), radars_left_out(observation)};
  if (examined.configuration.radars.empty()) {
    throw std::runtime_error(no_suggestion(observation));
  }
  return examined;
}

LocatedRadars found_radars(const Observation& observation) {
  LocatedRadars found = examined_radars(observation);
  const auto text = [](const RadarConfiguration& radar) {
    return concat({radar.name, ": ", radar.decoder.describe(), " on ", radar.interface});
  };
  const std::string radars = joined(found.configuration.radars, text);
  found.findings.push_back(
      {Severity::note,
       concat({"there is no configuration, so each radar is examined alone (", radars, ")"}),
       std::string(kWriteFirst)});
  add_silent_buses(observation, found.findings);
  return found;
}

}  // namespace cremed
