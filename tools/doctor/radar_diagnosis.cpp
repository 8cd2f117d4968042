// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/radar_diagnosis.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "daemon/process/message_text.hpp"
#include "daemon/report/report.hpp"

namespace cremed {
namespace {

using Findings = std::vector<Finding>;

const BusObservation& bus_of(const RadarConfiguration& radar, const Observation& observation) {
  return *std::ranges::find(observation.buses, radar.interface, &BusObservation::interface);
}

void erase(const RadarSettings& radar, std::vector<RadarSettings>& radars) {
  std::erase_if(radars, [&](const RadarSettings& other) { return other.is_same_radar(radar); });
}

/// Radars on a bus that match no radar of the configuration.
std::vector<RadarSettings> unclaimed(const BusObservation& bus,
                                     const Configuration& configuration) {
  std::vector<RadarSettings> radars = seen_radars(bus.traffic);
  for (const RadarConfiguration& radar : configuration.radars) {
    if (radar.interface == bus.interface) {
      erase(radar.decoder, radars);
    }
  }
  return radars;
}

bool contains(const std::vector<RadarSettings>& radars, const RadarSettings& wanted) {
  return std::ranges::any_of(
      radars, [&](const RadarSettings& radar) { return radar.is_same_radar(wanted); });
}

/// A radar of the same family is the likelier one.
std::optional<RadarSettings> most_likely(const std::vector<RadarSettings>& radars,
                                         const RadarSettings& expected) {
  for (const RadarSettings& radar : radars) {
    if (is_alike(radar.family(), expected.family())) {
      return radar;
    }
  }
  return radars.empty() ? std::nullopt : std::optional(radars.front());
}

/// The command that gives an ARS408 the configured id.
std::string sensor_id_command(const RadarConfiguration& radar, const Ars408Options& has) {
  return concat({"`cremed-doctor --configure-ars408 ", radar.name, " --sensor-id ",
                 number(has.sensor_id), "`"});
}

Finding other_radar(const RadarConfiguration& radar, const RadarSettings& seen) {
  const std::string what = concat({"not ", radar.decoder.describe(), " but ",
                                   seen.describe_to(radar.decoder), " is on ", radar.interface});
  if (is_alike(seen.family(), radar.decoder.family())) {
    const auto* const ars408 = seen.as<Ars408Options>();
    return {Severity::error, what,
            concat({"set ", seen.key(), " for radar ", in_quotes(radar.name),
                    ars408 == nullptr ? ""
                                      : concat({", or give the sensor its id: ",
                                                sensor_id_command(radar, *ars408)})})};
  }
  return {Severity::error, what,
          concat({"set type = ", in_quotes(seen.family().type), " and ", seen.key(), " for radar ",
                  in_quotes(radar.name)})};
}

/// Radars on a bus that may be the missing one: not claimed by another radar of the configuration.
std::vector<RadarSettings> candidates(const Configuration& configuration,
                                      const Observation& observation, const BusObservation& bus) {
  std::vector<RadarSettings> radars = unclaimed(bus, configuration);
  for (const RadarConfiguration& other : configuration.radars) {
    if (!contains(seen_radars(bus_of(other, observation).traffic), other.decoder)) {
      erase(other.decoder, radars);
    }
  }
  return radars;
}

/// The configured radar is not on its bus; names what is there instead.
Findings identify(const Configuration& configuration, const Observation& observation,
                  const RadarConfiguration& radar) {
  const BusObservation& bus = bus_of(radar, observation);
  if (const auto seen = most_likely(candidates(configuration, observation, bus), radar.decoder)) {
    return {other_radar(radar, *seen)};
  }
  return {{Severity::error,
           concat({"frames on ", radar.interface, ", but none of ", radar.decoder.describe(), ": ",
                   seen_ids(bus)}),
           concat({"check that radar ", in_quotes(radar.name),
                   " has power and is on this bus, and its type, sensor_id or base_id"})}};
}

/// Cluster or object lists without quality messages.
bool lacks_quality(const RadarConfiguration& radar, const BusObservation& bus) {
  const auto* const ars408 = radar.decoder.as<Ars408Options>();
  const auto seen = [&](Ars408Message message) {
    return frames_of(*ars408, message, bus.traffic) != 0;
  };
  using enum Ars408Message;
  return ars408 != nullptr && ((seen(cluster_general) && !seen(cluster_quality)) ||
                               (seen(object_general) && !seen(object_quality)));
}

/// The first and the last scan are cut by the observation.
bool are_many(const AssemblerCounters& scans) {
  constexpr std::uint64_t kCut = 2;
  return scans.incomplete_scans > kCut && scans.incomplete_scans * 50 > scans.scans;
}

/// A step of the clock may damage the scans on either side.
bool is_of_clock(const AssemblerCounters& scans) {
  return scans.stamps_backwards != 0 && scans.incomplete_scans <= 2 * scans.stamps_backwards + 2;
}

void add_incomplete(const RadarConfiguration& radar, const RadarObservation& observation,
                    Findings& findings) {
  // More clusters with quality do not fit in a cycle at 500 kbit/s, whatever their stuff bits.
  constexpr std::uint16_t kMaxTargetsPerCycle = 150;
  const AssemblerCounters& scans = observation.status.assembler;
  const IncompleteScans& incomplete = observation.incomplete;
  if (!are_many(scans) || is_of_clock(scans)) {
    return;
  }
  const Severity severity =
      scans.incomplete_scans == scans.scans ? Severity::error : Severity::warning;
  const bool has_header = radar.decoder.make_decoder()->framing().has_header;
  const std::string what = concat(
      {number(scans.incomplete_scans), " of ", number(scans.scans), " scans are incomplete: ",
       has_header ? "their headers announce " + number(incomplete.announced_targets) +
                        " targets, " + number(incomplete.whole_targets) + " complete"
                  : counted(scans.missing_parts, "frame") + " missing"});
  if (radar.decoder.as<Ars408Options>() != nullptr &&
      incomplete.most_announced > kMaxTargetsPerCycle) {
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

/// Rate of target lists with the radar's identifiers.
std::uint64_t lists_of(const RadarSettings& radar, const BusTraffic& bus) {
  if (const auto* gpr = radar.as<BoschGprOptions>()) {
    return bus.ids[gpr->base_id].frames;
  }
  const auto* const ars408 = radar.as<Ars408Options>();
  return ars408 == nullptr ? 0
                           : std::max(frames_of(*ars408, Ars408Message::cluster_status, bus),
                                      frames_of(*ars408, Ars408Message::object_status, bus));
}

std::string twin_remedy(const RadarConfiguration& radar, bool is_echo) {
  if (is_echo) {
    return "find the gateway that repeats frames; do not merge two logs of one bus";
  }
  const auto* const ars408 = radar.decoder.as<Ars408Options>();
  return ars408 == nullptr
             ? "give one of them a bus of its own, or another base id"
             : concat({"unplug one, give the other an id of its own (sensor_id, then ",
                       sensor_id_command(radar, *ars408), ")"});
}

/// Two radars with one id, by the rate of their lists. An ARS408 sends 13 to 17 a second; the rate
/// of a GPR is less certain, so its scans must also be damaged.
Findings find_twin(const RadarConfiguration& radar, const RadarObservation& observed,
                   const BusObservation& bus, double seconds) {
  constexpr double kShortestS = 0.5;
  const AssemblerCounters& scans = observed.status.assembler;
  const bool is_gpr = radar.decoder.as<BoschGprOptions>() != nullptr;
  const double pause_s = fell_silent(observed, seconds) ? observed.times.longest.length_s : 0.0;
  const std::uint64_t lists = lists_of(radar.decoder, bus.traffic);
  const double lists_hz = static_cast<double>(lists) / std::max(seconds - pause_s, kShortestS);
  const bool is_twin = lists_hz > (is_gpr ? 15.0 : 22.0);
  // The counters of two alternating sensors jump back and forth.
  const bool is_spoilt = 2 * (scans.incomplete_scans + scans.missed_scans) >= scans.scans;
  if (!is_twin || (is_gpr && !is_spoilt)) {
    return {};
  }
  const bool is_echo = scans.repeated_scans + scans.duplicate_parts > lists / 4;
  return {{Severity::error,
           concat({tenths(lists_hz), " lists a second from ", radar.decoder.describe(), " on ",
                   radar.interface, ", of one sensor ", is_gpr ? "10: " : "13 to 17: ",
                   is_echo ? "each frame comes twice" : "two sensors have this id"}),
           twin_remedy(radar, is_echo)}};
}

/// Whether the frames of several radars pause then, but for a scan before and one after.
bool is_of_all(const Pause& pause, const Observation& all) {
  return all.radars.size() > 1 && std::ranges::any_of(all.silences, [&](const Pause& silence) {
           return silence.overlaps(pause) && silence.length_s > pause.length_s - kShortestPauseS;
         });
}

/// The radar sent scans, but stopped or paused.
void add_pause(const RadarObservation& observed, const Observation& all, Findings& findings) {
  if (!fell_silent(observed, all.seconds)) {
    return;
  }
  const ScanTimes& times = observed.times;
  findings.push_back(
      {times.is_paused ? Severity::error : Severity::warning,
       concat({"no scan ",
               times.is_paused ? concat({"in the last ", tenths(times.longest.length_s)})
                               : concat({"from ", tenths(times.longest.begin_s), " to ",
                                         tenths(times.longest.end_s())}),
               " of ", tenths(all.seconds), " s, although it sent scans ",
               times.longest.begin_s > 0.0 ? "before" : "after that"}),
       is_of_all(times.longest, all)
           ? "no bus has a frame then: the computer stood still, its clock was set, or the supply "
             "failed"
           : "check its supply and plug for loose contacts; it may have restarted"});
}

std::string wrong_content_remedy(const RadarSettings& radar) {
  if (const auto* ars408 = radar.as<Ars408Options>()) {
    return concat({"another device (a Bosch GPR?) uses identifiers of sensor id ",
                   number(ars408->sensor_id),
                   ": give them buses of their own, or check type and sensor_id"});
  }
  return radar.as<BoschGprOptions>() != nullptr
             ? "check base_id, and that it is a General Purpose Radar"
             : concat({"check that it is ", radar.describe()});
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
         wrong_content_remedy(radar.decoder)});
  }
}

/// Whether its targets arrive at all. Another device may use a few of a GPR's identifiers.
bool is_heard(const RadarConfiguration& radar, const BusObservation& bus) {
  constexpr std::size_t kFirstArs408List = 0x600;
  const IdSet ids = radar.decoder.sent_ids();
  const IdSet heard = ids & bus.traffic.seen();
  return radar.decoder.as<Ars408Options>() != nullptr ? (heard >> kFirstArs408List).any()
                                                      : heard.count() > ids.count() / 2;
}

/// Findings if nothing else explains a missing estimate.
void add_no_estimate(const RadarConfiguration& radar, const RadarStatus& status,
                     const Configuration& configuration, bool is_live, Findings& findings) {
  if (status.assembler.scans == 0) {
    const bool is_ars408 = radar.decoder.as<Ars408Options>() != nullptr;
    findings.push_back(
        {Severity::error, "it reports its state but sends no targets",
         is_ars408 ? configure_command(radar) : "see its data sheet for what makes it send them"});
  } else if (estimates(status) == 0 && !is_contradicted(radar, status, configuration.radars)) {
    findings.push_back({Severity::error, concat({"no estimate yet: ", summary(status)}),
                        is_live ? "listen longer, `--seconds 10`" : "record 10 s or more"});
  }
}

bool has_error(const Findings& findings) {
  return std::ranges::any_of(
      findings, [](const Finding& finding) { return finding.severity == Severity::error; });
}

}  // namespace

bool fell_silent(const RadarObservation& observed, double seconds) {
  constexpr double kLongestS = 1.0;
  return observed.status.assembler.scans != 0 &&
         observed.times.longest.length_s > std::clamp(seconds / 3.0, kShortestPauseS, kLongestS);
}

Findings find_elsewhere(const Configuration& configuration, const Observation& observation,
                        const RadarConfiguration& wanted) {
  for (const BusObservation& bus : observation.buses) {
    if (bus.interface != wanted.interface &&
        contains(unclaimed(bus, configuration), wanted.decoder)) {
      return {{Severity::error,
               concat({wanted.decoder.describe(), " is on ", bus.interface, ", not on ",
                       wanted.interface}),
               concat({"set interface = ", in_quotes(bus.interface), " for radar ",
                       in_quotes(wanted.name)})}};
    }
  }
  return {};
}

Findings diagnose_radar(const Configuration& configuration, const Observation& observation,
                        std::size_t radar) {
  const RadarConfiguration& wanted = configuration.radars[radar];
  const RadarObservation& observed = observation.radars[radar];
  const BusObservation& bus = bus_of(wanted, observation);
  if (!contains(seen_radars(bus.traffic), wanted.decoder)) {
    Findings elsewhere = find_elsewhere(configuration, observation, wanted);
    if (!elsewhere.empty()) {
      return elsewhere;
    }
    if (!is_heard(wanted, bus) || !candidates(configuration, observation, bus).empty()) {
      return identify(configuration, observation, wanted);
    }
  }
  const RadarHealth& health = observed.status.health;
  if (lacks_quality(wanted, bus) && (!health.is_known || health.sends_quality)) {
    return {{Severity::error,
             concat({"the sensor sends targets without quality on ", wanted.interface,
                     ", so no scan is complete"}),
             configure_command(wanted)}};
  }
  if (Findings twin = find_twin(wanted, observed, bus, observation.seconds); !twin.empty()) {
    return twin;
  }
  Findings findings = radar_findings(wanted, observed.status, configuration.radars);
  add_pause(observed, observation, findings);
  if (!has_error(findings)) {
    add_incomplete(wanted, observed, findings);
  }
  if (!has_error(findings)) {
    add_no_estimate(wanted, observed.status, configuration, observation.is_live, findings);
  }
  add_bad_frames(wanted, observed.status, findings);
  return findings;
}

}  // namespace cremed
