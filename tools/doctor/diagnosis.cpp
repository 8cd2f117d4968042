// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/diagnosis.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <nlohmann/json.hpp>

#include "daemon/process/message_text.hpp"
#include "daemon/process/plain_text.hpp"
#include "daemon/report/report.hpp"
#include "daemon/report/vehicle_findings.hpp"
#include "tools/doctor/bus_findings.hpp"
#include "tools/doctor/observer.hpp"
#include "tools/doctor/radar_diagnosis.hpp"

namespace cremed {
namespace {

using Findings = std::vector<Finding>;

/// Within this time each radar sends some whole scans.
constexpr double kShortestLogS = 0.5;

void append(const Findings& more, Findings& findings) {
  findings.insert(findings.end(), more.begin(), more.end());
}

/// Each as "name: what".
void append_of(std::string_view name, Findings more, Findings& findings) {
  for (Finding& finding : more) {
    finding.what = concat({name, ": ", finding.what});
  }
  append(more, findings);
}

/// Of buses with radars of the configuration; a silent one only if not all of them are found on
/// another bus.
void add_buses(const Configuration& configuration, const Observation& observation,
               Findings& findings) {
  for (const BusObservation& bus : observation.buses) {
    const bool is_asked = std::ranges::any_of(configuration.radars, [&](const auto& radar) {
      return radar.interface == bus.interface &&
             (!is_silent(bus) || find_elsewhere(configuration, observation, radar).empty());
    });
    if (is_asked) {
      append(bus_findings(bus, observation), findings);
    }
  }
}

/// A radar's findings, each with its name. On a silent bus the only finding is where else it is.
void add_radar(const Configuration& configuration, const Observation& observation,
               std::size_t radar, Findings& findings) {
  const RadarConfiguration& wanted = configuration.radars[radar];
  const auto bus =
      std::ranges::find(observation.buses, wanted.interface, &BusObservation::interface);
  append_of(wanted.name,
            is_silent(*bus) ? find_elsewhere(configuration, observation, wanted)
                            : diagnose_radar(configuration, observation, radar),
            findings);
}

/// One that was set back is told by the stamps of each bus.
void add_clock(const Observation& observation, Findings& findings) {
  if (observation.forward_steps != 0) {
    findings.push_back(
        {Severity::warning,
         concat({"the clock was set forward ", counted(observation.forward_steps, "time"),
                 ", by up to ", tenths(std::max(observation.longest_step_s, 0.1)),
                 " s: the radars count their cycles on"}),
         "no motion spans that; find what sets it, `timedatectl`, and let it be set before a "
         "drive"});
  }
}

void add_vehicle(const VehicleConfiguration& vehicle, const Observation& observation,
                 Findings& findings) {
  for (std::size_t i = 0; i < observation.vehicle.size(); ++i) {
    const auto signal = static_cast<VehicleSignal>(i);
    if (vehicle.is_used(signal)) {
      append_of(vehicle_signal_name(signal),
                vehicle_findings(vehicle, signal, observation.vehicle[i], true), findings);
    }
  }
}

void add_common_mount(const Configuration& configuration, const Observation& observation,
                      Findings& findings) {
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    const RadarStatus& status = observation.radars[i].status;
    if (const auto finding = common_mount(configuration, configuration.radars[i], status)) {
      findings.insert(findings.begin(), *finding);
      return;
    }
  }
}

using Json = nlohmann::ordered_json;

Json to_json(const Finding& finding) {
  return {{"severity", severity_name(finding.severity)},
          {"what", plain_text(finding.what)},
          {"remedy", plain_text(finding.remedy)}};
}

Json to_json(const RadarConfiguration& radar, const RadarObservation& observed) {
  return {{"radar", radar.name},
          {"interface", radar.interface},
          {"frames", observed.status.decoder.frames},
          {"scans", observed.status.assembler.scans},
          {"incomplete_scans", observed.status.assembler.incomplete_scans},
          {"estimates", estimates(observed.status)},
          {"longest_pause_s", observed.times.longest.length_s}};
}

}  // namespace

Findings diagnose(const Configuration& configuration, const Observation& observation) {
  Findings findings;
  if (!observation.kernel_has_can) {
    findings.push_back({Severity::error, "the kernel has no CAN sockets",
                        "`modprobe can_raw`, or a kernel built with CONFIG_CAN"});
  } else if (!observation.is_live && observation.seconds < kShortestLogS) {
    findings.push_back({Severity::error,
                        "the log lasts less than half a second: too short to tell anything",
                        "record 10 s or more"});
  } else {
    for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
      add_radar(configuration, observation, i, findings);
    }
    add_common_mount(configuration, observation, findings);
    add_buses(configuration, observation, findings);
    add_clock(observation, findings);
    add_vehicle(configuration.vehicle, observation, findings);
    append(odometry_findings(observation.odometry, configuration.radars.size()), findings);
  }
  if (!observation.malformed_lines.empty()) {
    findings.push_back({Severity::warning, observation.malformed_lines,
                        "they are left out, and frames that they held are missing; record with "
                        "`candump -l`"});
  }
  if (observation.frames_lost_of_any != 0) {
    findings.push_back({Severity::warning,
                        concat({counted(observation.frames_lost_of_any, "frame"),
                                " lost before they were read, of any bus"}),
                        "find what keeps the processor busy, or record with `candump -r 1048576`"});
  }
  if (observation.frames_left_out != 0) {
    findings.push_back({Severity::warning,
                        concat({counted(observation.frames_left_out, "frame"),
                                " of further interfaces ignored: at most ",
                                std::to_string(kMaxBuses), " interfaces are analysed"}),
                        "is this a log of candump? Its second column names the interface"});
  }
  if (!observation.lcm_problem.empty()) {
    findings.push_back({Severity::error, "LCM cannot send", observation.lcm_problem});
  }
  std::ranges::stable_sort(findings, {}, &Finding::severity);
  return findings;
}

const char* severity_name(Severity severity) {
  return severity == Severity::error ? "error" : severity == Severity::warning ? "warning" : "note";
}

bool is_well(const Findings& findings) {
  return std::ranges::all_of(
      findings, [](const Finding& finding) { return finding.severity == Severity::note; });
}

std::string vital_signs(const RadarConfiguration& radar, const RadarObservation& observation,
                        double seconds) {
  const auto scans = static_cast<double>(observation.status.assembler.scans);
  const bool has_pause = fell_silent(observation, seconds);
  const double sent_s = seconds - (has_pause ? observation.times.longest.length_s : 0.0);
  return concat({radar.name, ": ", tenths(sent_s > 0.0 ? scans / sent_s : 0.0), " scans/s",
                 has_pause ? concat({" in ", tenths(sent_s), " of ", tenths(seconds), " s"}) : "",
                 ", ", std::to_string(estimates(observation.status)), " estimates"});
}

std::string diagnosis_json(const Configuration& configuration, const Observation& observation,
                           const std::vector<Finding>& findings) {
  Json json{{"good", is_well(findings)},
            {"seconds", observation.seconds},
            {"findings", Json::array()},
            {"radars", Json::array()}};
  for (const Finding& finding : findings) {
    json["findings"].push_back(to_json(finding));
  }
  for (std::size_t i = 0; i < configuration.radars.size(); ++i) {
    json["radars"].push_back(to_json(configuration.radars[i], observation.radars[i]));
  }
  return json.dump(2);
}

}  // namespace cremed
