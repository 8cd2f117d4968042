// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/radar_diagnosis.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/report/report.hpp"
#include "tools/doctor/seen_radar.hpp"

namespace cremed {
namespace {

using Findings = std::vector<Finding>;

std::string number(std::uint64_t value) { return std::to_string(value); }

const BusObservation& bus_of(const RadarConfiguration& radar, const Observation& observation) {
  return *std::find_if(observation.buses.begin(), observation.buses.end(),
                       [&](const auto& bus) { return bus.interface == radar.interface; });
}

/// Radars on a bus that no radar of the configuration is meant to be.
std::vector<SeenRadar> unclaimed(const BusObservation& bus, const Configuration& configuration) {
  std::vector<SeenRadar> radars = seen_radars(bus);
  for (const RadarConfiguration& radar : configuration.radars) {
    if (radar.interface == bus.interface) {
      std::erase(radars, expected_radar(radar));
    }
  }
  return radars;
}

bool contains(const std::vector<SeenRadar>& radars, const SeenRadar& wanted) {
  return std::find(radars.begin(), radars.end(), wanted) != radars.end();
}

std::string quoted_name(const RadarConfiguration& radar) { return quoted(radar.name); }

/// Another radar of the same kind is more likely than one of the other kind.
std::optional<SeenRadar> most_likely(const std::vector<SeenRadar>& radars,
                                     const SeenRadar& expected) {
  for (const SeenRadar& radar : radars) {
    if (radar.kind == expected.kind) {
      return radar;
    }
  }
  return radars.empty() ? std::nullopt : std::optional(radars.front());
}

Finding other_radar(const RadarConfiguration& radar, const SeenRadar& expected,
                    const SeenRadar& seen) {
  const std::string what =
      concat({"not ", to_text(expected), " but ", to_text(seen), " is on ", radar.interface});
  if (seen.kind == expected.kind) {
    return {Severity::error, what,
            concat({"set ", key_of(seen), " for radar ", quoted_name(radar),
                    seen.kind == SeenRadar::Kind::ars408
                        ? concat({", or give the sensor its id: `cremed-doctor --configure-ars408 ",
                                  radar.name, " --sensor-id ", number(seen.number), "`"})
                        : ""})};
  }
  return {
      Severity::error, what,
      concat({"set type = ", seen.kind == SeenRadar::Kind::ars408 ? "\"ars408\"" : "\"bosch_gpr\"",
              " and ", key_of(seen), " for radar ", quoted_name(radar)})};
}

/// Radars on a bus that may be the one that is missing there: none that another radar of the
/// configuration is looking for.
std::vector<SeenRadar> candidates(const Configuration& configuration,
                                  const Observation& observation, const BusObservation& bus) {
  std::vector<SeenRadar> radars = unclaimed(bus, configuration);
  for (const RadarConfiguration& other : configuration.radars) {
    const SeenRadar expected = expected_radar(other);
    if (!contains(seen_radars(bus_of(other, observation)), expected)) {
      std::erase(radars, expected);
    }
  }
  return radars;
}

/// The configured radar is not on its bus: what is there instead.
Findings identify(const Configuration& configuration, const Observation& observation,
                  const RadarConfiguration& radar) {
  const BusObservation& bus = bus_of(radar, observation);
  const SeenRadar expected = expected_radar(radar);
  if (const auto seen = most_likely(candidates(configuration, observation, bus), expected)) {
    return {other_radar(radar, expected, *seen)};
  }
  return {{Severity::error,
           concat({"frames on ", radar.interface, ", but none of ", to_text(expected), ": ",
                   seen_ids(bus)}),
           concat({"check that radar ", quoted_name(radar),
                   " has power and is on this bus, and its type, sensor_id or base_id"})}};
}

/// Cluster or object lists without the message that says how good each target is.
bool lacks_quality(const RadarConfiguration& radar, const BusObservation& bus) {
  const SeenRadar expected = expected_radar(radar);
  const std::size_t shift = std::size_t{0x10} * expected.number;
  const auto seen = [&](std::size_t id) { return bus.ids[id + shift].frames != 0; };
  return expected.kind == SeenRadar::Kind::ars408 &&
         ((seen(0x701) && !seen(0x702)) || (seen(0x60B) && !seen(0x60C)));
}

std::string quality_off(const RadarConfiguration& radar) {
  return concat(
      {"the sensor sends targets without quality on ", radar.interface, ", so no scan is whole"});
}

/// The first and the last scan are cut by the beginning and the end of the observation.
bool are_many(const AssemblerCounters& scans) {
  constexpr std::uint64_t kCut = 2;
  return scans.incomplete_scans > kCut && scans.incomplete_scans * 50 > scans.scans;
}

/// A step of the clock may spoil the scans on either side of it.
bool is_of_clock(const AssemblerCounters& scans) {
  return scans.stamps_backwards != 0 && scans.incomplete_scans <= 2 * scans.stamps_backwards + 2;
}

void add_incomplete(const RadarConfiguration& radar, const RadarObservation& observation,
                    Findings& findings) {
  // More clusters with quality than this do not fit in a cycle at 500 kbit/s, whatever their bits.
  constexpr std::uint16_t kMostThatFit = 150;
  const AssemblerCounters& scans = observation.status.assembler;
  const IncompleteScans& incomplete = observation.incomplete;
  if (!are_many(scans) || is_of_clock(scans)) {
    return;
  }
  const Severity severity =
      scans.incomplete_scans == scans.scans ? Severity::error : Severity::warning;
  const bool has_header = expected_radar(radar).kind == SeenRadar::Kind::ars408;
  const std::string what =
      concat({number(scans.incomplete_scans), " of ", number(scans.scans), " scans are not whole: ",
              has_header ? "their headers say " + number(incomplete.announced_targets) +
                               " targets, " + number(incomplete.whole_targets) + " came whole"
                         : counted(scans.missing_parts, "frame") + " missing"});
  if (has_header && incomplete.most_announced > kMostThatFit) {
    findings.push_back(
        {severity, what,
         concat({"up to ", number(incomplete.most_announced),
                 " do not fit on the bus: shorten the range, `cremed-doctor --configure-ars408 ",
                 radar.name, " --max-distance 200`, or let the sensor filter, ",
                 "`cremed-doctor --ars408-filters ", radar.name, " --filter rcs=-5..50`"})});
  } else {
    findings.push_back({severity, what,
                        "frames are lost on the way: look at the load of bus and computer, and "
                        "for a second node that sends these identifiers"});
  }
}

/// Lists of targets that came with the radar's identifiers.
std::uint64_t lists_of(const SeenRadar& radar, const BusObservation& bus) {
  const auto frames = [&](Ars408Message message) {
    return bus.ids[ars408_id(static_cast<std::uint32_t>(message), radar.number)].frames;
  };
  return radar.kind == SeenRadar::Kind::bosch_gpr ? bus.ids[radar.number].frames
                                                  : std::max(frames(Ars408Message::cluster_status),
                                                             frames(Ars408Message::object_status));
}

std::string twin_remedy(const RadarConfiguration& radar, const SeenRadar& twin, bool is_echo) {
  if (is_echo) {
    return "look for a gateway that repeats frames; do not merge two logs of one bus";
  }
  if (twin.kind == SeenRadar::Kind::bosch_gpr) {
    return "give one of them a bus of its own, or another base id";
  }
  return concat({"unplug one, give the other an id of its own (sensor_id, then ",
                 "`cremed-doctor --configure-ars408 ", radar.name, " --sensor-id ",
                 number(twin.number), "`)"});
}

/// Two sensors with one id, by how often their lists come. An ARS408 sends 13 to 17 a second; of a
/// GPR the rate is less certain, so its scans have to be spoilt as well.
Findings find_twin(const RadarConfiguration& radar, const RadarObservation& observed,
                   const BusObservation& bus, double seconds) {
  constexpr double kShortestS = 0.5;
  const SeenRadar expected = expected_radar(radar);
  const AssemblerCounters& scans = observed.status.assembler;
  const bool is_gpr = expected.kind == SeenRadar::Kind::bosch_gpr;
  const double pause_s = fell_silent(observed, seconds) ? observed.times.longest_pause_s : 0.0;
  const std::uint64_t lists = lists_of(expected, bus);
  const double lists_hz = static_cast<double>(lists) / std::max(seconds - pause_s, kShortestS);
  const bool is_twin = lists_hz > (is_gpr ? 15.0 : 22.0);
  // Counters of two that come in turn skip to and fro.
  const bool is_spoilt = 2 * (scans.incomplete_scans + scans.missed_scans) >= scans.scans;
  if (!is_twin || (is_gpr && !is_spoilt)) {
    return {};
  }
  const bool is_echo = scans.repeated_scans + scans.duplicate_parts > lists / 4;
  return {{Severity::error,
           concat({tenths(lists_hz), " lists a second from ", to_text(expected), " on ",
                   radar.interface, ", of one sensor ", is_gpr ? "10: " : "13 to 17: ",
                   is_echo ? "each frame comes twice" : "two sensors have this id"}),
           twin_remedy(radar, expected, is_echo)}};
}

/// It was there, and is not any more, or not all the time.
void add_pause(const RadarObservation& observed, double seconds, Findings& findings) {
  if (!fell_silent(observed, seconds)) {
    return;
  }
  const ScanTimes& times = observed.times;
  const double end_s = times.pause_begin_s + times.longest_pause_s;
  findings.push_back(
      {times.is_paused ? Severity::error : Severity::warning,
       concat({"no scan ",
               times.is_paused
                   ? concat({"in the last ", tenths(times.longest_pause_s)})
                   : concat({"from ", tenths(times.pause_begin_s), " to ", tenths(end_s)}),
               " of ", tenths(seconds), " s, though it sent them ",
               times.pause_begin_s > 0.0 ? "before" : "after that"}),
       "check its supply and plug for loose contacts; it may have restarted"});
}

void add_bad_frames(const RadarConfiguration& radar, const RadarStatus& status,
                    Findings& findings) {
  const DecoderCounters& c = status.decoder;
  if (c.crc_errors != 0) {
    findings.push_back({Severity::warning,
                        counted(c.crc_errors, "frame") + " with a wrong checksum",
                        "check the cable; if it is all of them, set crc_policy = \"off\""});
  }
  if (c.wrong_length + c.wrong_kind != 0) {
    findings.push_back({Severity::warning,
                        counted(c.wrong_length + c.wrong_kind, "frame") +
                            " of the wrong length, remote or FD on its identifiers",
                        "find the other node that sends them, `candump -e any`"});
  }
  if (c.wrong_slot != 0) {
    findings.push_back(
        {Severity::warning,
         counted(c.wrong_slot, "frame") + " whose content contradicts the identifier",
         expected_radar(radar).kind == SeenRadar::Kind::ars408
             ? concat({"another device (a Bosch GPR?) uses identifiers of sensor id ",
                       std::to_string(expected_radar(radar).number),
                       ": give them buses of their own, or check type and sensor_id"})
             : "check base_id, and that it is a General Purpose Radar"});
  }
}

/// Do its targets come at all? A few of a GPR's identifiers may be those of others.
bool is_heard(const RadarConfiguration& radar, const BusObservation& bus) {
  constexpr std::size_t kFirstArs408List = 0x600;
  const bool is_gpr = expected_radar(radar).kind == SeenRadar::Kind::bosch_gpr;
  const IdSet ids = sent_ids(radar);
  std::size_t heard = 0;
  for (std::size_t id = is_gpr ? 0 : kFirstArs408List; id < ids.size(); ++id) {
    heard += ids[id] && bus.ids[id].frames != 0 ? 1 : 0;
  }
  return heard > (is_gpr ? ids.count() / 2 : 0);
}

/// What remains if nothing else explains that there is no estimate.
void add_no_estimate(const RadarConfiguration& radar, const RadarStatus& status,
                     Findings& findings) {
  if (status.assembler.scans == 0) {
    findings.push_back({Severity::error, "it reports its state but sends no targets",
                        concat({"`cremed-doctor --configure-ars408 ", radar.name, "`"})});
  } else if (estimates(status) == 0) {
    findings.push_back({Severity::error, concat({"no estimate yet: ", summary(status)}),
                        "listen longer, `--seconds 10`"});
  }
}

bool has_error(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::error; });
}

}  // namespace

bool fell_silent(const RadarObservation& observed, double seconds) {
  constexpr double kShortestS = 0.3;
  constexpr double kLongestS = 1.0;
  return observed.status.assembler.scans != 0 &&
         observed.times.longest_pause_s > std::clamp(seconds / 3.0, kShortestS, kLongestS);
}

Findings find_elsewhere(const Configuration& configuration, const Observation& observation,
                        std::size_t radar) {
  const RadarConfiguration& wanted = configuration.radars[radar];
  const SeenRadar expected = expected_radar(wanted);
  for (const BusObservation& bus : observation.buses) {
    if (bus.interface != wanted.interface && contains(unclaimed(bus, configuration), expected)) {
      return {{Severity::error,
               concat({to_text(expected), " is on ", bus.interface, ", not on ", wanted.interface}),
               concat({"set interface = ", quoted(bus.interface), " for radar ",
                       quoted_name(wanted)})}};
    }
  }
  return {};
}

Findings diagnose_radar(const Configuration& configuration, const Observation& observation,
                        std::size_t radar) {
  const RadarConfiguration& wanted = configuration.radars[radar];
  const RadarObservation& observed = observation.radars[radar];
  const BusObservation& bus = bus_of(wanted, observation);
  if (!contains(seen_radars(bus), expected_radar(wanted))) {
    Findings elsewhere = find_elsewhere(configuration, observation, radar);
    if (!elsewhere.empty()) {
      return elsewhere;
    }
    if (!is_heard(wanted, bus) || !candidates(configuration, observation, bus).empty()) {
      return identify(configuration, observation, wanted);
    }
  }
  const RadarHealth& health = observed.status.health;
  if (lacks_quality(wanted, bus) && (!health.is_known || health.sends_quality)) {
    return {{Severity::error, quality_off(wanted),
             concat({"`cremed-doctor --configure-ars408 ", wanted.name, "`"})}};
  }
  if (Findings twin = find_twin(wanted, observed, bus, observation.seconds); !twin.empty()) {
    return twin;
  }
  Findings findings = radar_findings(wanted, observed.status);
  add_pause(observed, observation.seconds, findings);
  if (!has_error(findings)) {
    add_incomplete(wanted, observed, findings);
  }
  if (!has_error(findings)) {
    add_no_estimate(wanted, observed.status, findings);
  }
  add_bad_frames(wanted, observed.status, findings);
  return findings;
}

}  // namespace cremed
