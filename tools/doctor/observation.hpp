// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "daemon/output/radar_status.hpp"
#include "daemon/report/odometry_tally.hpp"
#include "daemon/report/vehicle_findings.hpp"
#include "tools/doctor/bus_observation.hpp"

namespace cremed {

/// The incomplete scans of one radar: targets announced and received.
struct IncompleteScans {
  std::uint64_t announced_targets = 0;
  std::uint64_t whole_targets = 0;  ///< With all messages.
  std::uint16_t most_announced = 0;
};

/// Times of scans, in seconds of traffic.
struct ScanTimes {
  double last_s = 0.0;  ///< The latest; 0: none yet.
  double longest_pause_s = 0.0;
  double pause_begin_s = 0.0;
  bool is_paused = false;  ///< The longest pause lasts until the end of the observation.

  void note(double now_s) {
    is_paused = now_s - last_s > longest_pause_s;
    if (is_paused) {
      longest_pause_s = now_s - last_s;
      pause_begin_s = last_s;
    }
    last_s = now_s;
  }
};

/// The pipeline's results for one radar.
struct RadarObservation {
  RadarStatus status;
  ScanTimes times;
  IncompleteScans incomplete;
};

/// Input of the diagnosis.
struct Observation {
  bool is_live = false;
  bool kernel_has_can = true;
  double seconds = 0.0;  ///< Of traffic.
  std::string lcm_problem;
  std::string malformed_lines;           ///< Of a log, the first and how many; empty: none.
  std::vector<BusObservation> buses;     ///< Those of the configuration, and others that exist.
  std::uint64_t frames_left_out = 0;     ///< Of interfaces beyond kMaxBuses.
  std::vector<RadarObservation> radars;  ///< In the order of the configuration.
  OdometryTally odometry;
  std::array<VehicleStatus, kVehicleSignals> vehicle{};  ///< Signals of [vehicle].
};

}  // namespace cremed
