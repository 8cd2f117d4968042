// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/doctor/suggestion.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "daemon/configuration/configuration.hpp"
#include "daemon/configuration/configuration_radar.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/process/message_text.hpp"
#include "tools/doctor/bus_findings.hpp"

namespace cremed {
namespace {

constexpr std::string_view kHeading =
    "# Radars found by cremed-doctor. Fill in the mounts, choose names, and check the file:\n"
    "# `cremed --check-config FILE`. Yaw to 20 degrees will do: `cremed-eval calibrate LOG\n"
    "# --config FILE --write` refines it. config/cremed.toml of cremed explains all keys.\n";

constexpr std::string_view kMount =
    "[radar.mount]  # From the middle of the rear axle.\n"
    "x_m = \"FILL IN\"      # m, forward\n"
    "y_m = \"FILL IN\"      # m, to the left\n"
    "yaw_rad = \"FILL IN\"  # rad, direction of view: 0 ahead, 1.5708 to the left, 3.1416 back\n";

constexpr std::string_view kNoMount = "mount = { x_m = 0, y_m = 0, yaw_rad = 0 }\n";

/// What is written of a radar beside its type and place.
struct TableEnd {
  std::string_view mount;
  bool has_output;  ///< As it is sent; else clusters.
};

/// A common odometry needs the mounts, a radar's own motion with 2 degrees of freedom too.
constexpr std::string_view kExamined =
    "odometry.enabled = false\nestimator.degrees_of_freedom = 3\n";

/// A name that the configuration takes as it is.
bool is_suggestible(const std::string& interface) {
  return is_interface_name(interface) && interface != kAutoInterface &&
         interface.find_first_of("\"\\") == std::string::npos;
}

std::vector<const BusObservation*> by_name(const Observation& observation) {
  std::vector<const BusObservation*> buses;
  for (const BusObservation& bus : observation.buses) {
    if (is_suggestible(bus.interface)) {
      buses.push_back(&bus);
    }
  }
  std::ranges::sort(buses, {}, &BusObservation::interface);
  return buses;
}

/// Advice for an ARS408 that does not send clusters.
std::string output_line(const BusObservation& bus, const RadarSettings& radar) {
  const auto* const ars408 = radar.as<Ars408Options>();
  const auto has = [&](Ars408Message message) {
    return frames_of(*ars408, message, bus.traffic) != 0;
  };
  if (ars408 == nullptr || has(Ars408Message::cluster_status)) {
    return "";
  }
  return has(Ars408Message::object_status)
             ? "output = \"objects\"  # as it sends now; \"clusters\" are far better: "
               "`cremed-doctor --configure-ars408 NAME` sets them\n"
             : "# It sends no targets now: `cremed-doctor --configure-ars408 NAME`.\n";
}

/// A comment with the types that cannot be distinguished from `family`; empty: none.
std::string others_like(const RadarFamily& family, RadarFamilies families) {
  std::string types;
  for (const RadarFamily* other : families) {
    if (other != &family && is_alike(*other, family)) {
      types += concat({types.empty() ? "  # or " : ", ", in_quotes(other->type)});
    }
  }
  return types.empty() ? "" : types + " (see the label of the sensor): the frames are the same";
}

/// What it uses of a bus, without a GPR's info_id, which is not observed.
IdSet observed_ids(const RadarSettings& radar) {
  if (const auto* const gpr = radar.as<BoschGprOptions>()) {
    BoschGprOptions targets = *gpr;
    targets.info_id = targets.base_id;
    return RadarSettings(targets).sent_ids();
  }
  return radar.sent_ids() | radar.obeyed_ids();
}

/// With an info_id that nothing on the bus uses: the usual one, if that is free.
RadarSettings with_free_info_id(const RadarSettings& radar, IdSet& used) {
  const auto* const gpr = radar.as<BoschGprOptions>();
  if (gpr == nullptr) {
    return radar;
  }
  BoschGprOptions options = *gpr;
  while (used[options.info_id]) {
    options.info_id = (options.info_id + 1) % static_cast<std::uint32_t>(used.size());
  }
  used.set(options.info_id);
  return options;
}

std::string info_line(const RadarSettings& radar) {
  const auto* const gpr = radar.as<BoschGprOptions>();
  return gpr == nullptr || gpr->info_id == BoschGprOptions().info_id
             ? ""
             : concat({"info_id = ", hexadecimal(gpr->info_id),
                       "  # free here; the sensor's own is in its setup\n"});
}

std::string table(const BusObservation& bus, const RadarSettings& radar, std::size_t number,
                  RadarFamilies families, const TableEnd& end) {
  return concat({"\n[[radar]]\nname = \"radar", std::to_string(number), "\"\ntype = \"",
                 radar.family().type, "\"", others_like(radar.family(), families),
                 "\ninterface = \"", bus.interface, "\"\n", radar.key(), "\n", info_line(radar),
                 end.has_output ? output_line(bus, radar) : "", end.mount});
}

Finding left_out(const BusObservation& bus, const RadarSettings& radar, const IdSet& shared) {
  return {
      Severity::warning,
      concat({radar.describe(), " on ", bus.interface, " is left out: it shares CAN identifier ",
              hexadecimal(shared._Find_first()), " with another radar there"}),
      "give it other identifiers, or a bus of its own"};
}

/// Radars of a bus that a configuration may have together, and the others: it refuses those that
/// share an identifier.
struct Recognised {
  std::vector<RadarSettings> radars;
  IdSet used;
  std::vector<Finding> left_out;
};

Recognised recognised(const BusObservation& bus, RadarFamilies families) {
  Recognised on_bus;
  for (const RadarSettings& radar : seen_radars(bus.traffic, families)) {
    const IdSet ids = observed_ids(radar);
    if ((on_bus.used & ids).any()) {
      on_bus.left_out.push_back(left_out(bus, radar, on_bus.used & ids));
    } else {
      on_bus.used |= ids;
      on_bus.radars.push_back(radar);
    }
  }
  return on_bus;
}

std::string tables_of(const BusObservation& bus, RadarFamilies families, const TableEnd& end,
                      std::size_t& count) {
  Recognised on_bus = recognised(bus, families);
  std::string tables;
  for (const RadarSettings& radar : on_bus.radars) {
    tables += count < kMaxRadars
                  ? table(bus, with_free_info_id(radar, on_bus.used), ++count, families, end)
                  : "";
  }
  for (const Finding& finding : on_bus.left_out) {
    tables += concat({"\n# ", to_text(finding), ".\n"});
  }
  return tables;
}

std::string tables_of(const Observation& observation, RadarFamilies families, const TableEnd& end) {
  std::string tables;
  std::size_t count = 0;
  for (const BusObservation* bus : by_name(observation)) {
    tables += tables_of(*bus, families, end, count);
  }
  return tables;
}

}  // namespace

std::string suggested_configuration(const Observation& observation, RadarFamilies families) {
  const std::string tables = tables_of(observation, families, {kMount, true});
  return tables.empty() ? "" : concat({kHeading, tables});
}

Configuration examined_configuration(const Observation& observation, ExaminedOutput output) {
  const std::string tables =
      tables_of(observation, radar_families(), {kNoMount, output == ExaminedOutput::as_sent});
  return tables.empty() ? Configuration()
                        : parse_configuration(concat({kExamined, tables}), "suggestion");
}

std::vector<Finding> radars_left_out(const Observation& observation) {
  std::vector<Finding> findings;
  for (const BusObservation* bus : by_name(observation)) {
    const Recognised on_bus = recognised(*bus, radar_families());
    findings.insert(findings.end(), on_bus.left_out.begin(), on_bus.left_out.end());
  }
  return findings;
}

void drop_doubts_of_mounts(Observation& observation) {
  for (RadarObservation& radar : observation.radars) {
    radar.status.belief.doubts &= positions_contradict_speed;
    radar.status.odometry.cause = {};
  }
}

std::string no_suggestion(const Observation& observation) {
  if (!observation.kernel_has_can) {
    return "the kernel has no CAN sockets; `modprobe can_raw`";
  }
  if (observation.buses.empty()) {
    return "there is no CAN interface; plug in an adapter and load its driver";
  }
  std::string text = "no radar was recognised, so there is nothing to suggest";
  for (const BusObservation& bus : observation.buses) {
    const std::vector<Finding> findings = bus_findings(bus, observation);
    text += findings.empty() ? concat({"\n", bus.interface, ": frames, but none of a radar (",
                                       seen_ids(bus), "); is it switched on?"})
                             : concat({"\n", to_text(findings.front())});
  }
  return text;
}

}  // namespace cremed
