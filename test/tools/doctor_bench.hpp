// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Recording on several buses, its observation and its diagnosis, in memory.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/configuration/interfaces.hpp"
#include "test/tools/fake_ars408.hpp"
#include "test/tools/simulated_drive.hpp"
#include "tools/doctor/diagnosis.hpp"
#include "tools/doctor/observer.hpp"
#include "tools/simulate/ars408_encoder.hpp"

namespace cremed::test {

struct BusFrame {
  std::string interface;
  CanFrame frame;
};
using Recording = std::vector<BusFrame>;

/// The radars of the demo: an ARS408 in front on can0, a GPR at the rear on can1.
inline Configuration demo_configuration() {
  Configuration configuration;
  configuration.radars = default_radars();
  configuration.output.lcm_url = "none";
  return configuration;
}

/// Three seconds of a drive with these radars.
inline Recording recording_of(const std::vector<RadarConfiguration>& radars) {
  SimulationOptions options;
  options.seed = 4;
  options.duration_s = 3.0;
  const Drive driven = drive(scenario("bends"), radars, options);
  Configuration configuration;
  configuration.radars = radars;
  const std::vector<std::string> names = interface_names(configuration);
  Recording traffic;
  for (const CanFrame& frame : driven.frames) {
    traffic.push_back({names[frame.interface], frame});
  }
  return traffic;
}

inline void remove_if(Recording& traffic, const std::function<bool(const BusFrame&)>& condition) {
  traffic.erase(std::remove_if(traffic.begin(), traffic.end(), condition), traffic.end());
}

/// Puts this 0x201 before everything else and removes all others.
inline void report_state(Recording& traffic, const std::string& interface,
                         const Ars408RadarState& state) {
  CanFrame frame = encode_ars408(state.sensor_id, state);
  frame.stamp_us = traffic.front().frame.stamp_us;
  remove_if(traffic, [&](const BusFrame& entry) {
    return entry.interface == interface && entry.frame.id == frame.id;
  });
  traffic.insert(traffic.begin(), {interface, frame});
}

inline bool is_of(const BusFrame& entry, const std::string& interface, std::uint32_t id) {
  return entry.interface == interface && entry.frame.id == id;
}

inline void move_ids(Recording& traffic, const std::string& interface, std::uint32_t shift) {
  for (BusFrame& entry : traffic) {
    entry.frame.id += entry.interface == interface ? shift : 0;
  }
}

inline void rename(Recording& traffic, const std::string& from, const std::string& to) {
  for (BusFrame& entry : traffic) {
    if (entry.interface == from) {
      entry.interface = to;
    }
  }
}

inline Observation observe(const Configuration& configuration, const Recording& traffic) {
  Observer observer(configuration);
  for (const BusFrame& entry : traffic) {
    observer.add(entry.interface, entry.frame);
  }
  Observation observation = observer.finish();
  observation.is_live = true;
  return observation;
}

inline std::string all_text(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += to_text(finding) + "\n";
  }
  return text;
}

/// Checks the first finding.
inline void check_first(const std::vector<Finding>& findings, Severity severity,
                        const std::string& what, const std::string& remedy) {
  CAPTURE(all_text(findings));
  REQUIRE_FALSE(findings.empty());
  CHECK(findings.front().severity == severity);
  CHECK_THAT(findings.front().what, Catch::Contains(what));
  CHECK_THAT(findings.front().remedy, Catch::Contains(remedy));
}

}  // namespace cremed::test
