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

/// A longer one in a log is a clock that was set, or a paused recording, and no traffic.
inline constexpr double kLongestPauseS = 10.0;

/// A shorter one between scans or frames is none: three scans of most radars.
inline constexpr double kShortestPauseS = 0.3;

struct Pause {
  double begin_s = 0.0;
  double length_s = 0.0;

  [[nodiscard]] double end_s() const { return begin_s + length_s; }
  [[nodiscard]] bool overlaps(const Pause& other) const {
    return begin_s < other.end_s() && other.begin_s < end_s();
  }
};

/// Times of a radar's scans, in seconds of traffic.
struct ScanTimes {
  double last_s = 0.0;  ///< The latest; 0: none yet.
  Pause longest;
  Pause longest_before;    ///< Until that one.
  bool is_paused = false;  ///< The longest pause lasts until the end of the observation.

  void note(double now_s) {
    is_paused = now_s - last_s > longest.length_s;
    if (is_paused) {
      longest_before = longest;
      longest = {last_s, now_s - last_s};
    }
    last_s = now_s;
  }
  /// A clock that was set forward made this pause.
  void leave_out(const Pause& step) {
    if (last_s < step.end_s()) {
      return;  // None since: the next is noted without it.
    }
    last_s -= step.length_s;
    if (longest.length_s >= step.length_s && longest.overlaps(step)) {
      longest = longest_before;
    }
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
  double seconds = 0.0;             ///< Of traffic.
  std::vector<Pause> silences;      ///< Longer than kShortestPauseS, without a frame of any bus.
  std::uint64_t forward_steps = 0;  ///< Of the clock, by the radars' cycle counters.
  double longest_step_s = 0.0;
  std::string lcm_problem;
  std::string malformed_lines;           ///< Of a log, the first and how many; empty: none.
  std::vector<BusObservation> buses;     ///< Those of the configuration, and others that exist.
  std::uint64_t frames_lost_of_any = 0;  ///< By `candump any`, of an unknown bus.
  std::uint64_t frames_left_out = 0;     ///< Of interfaces beyond kMaxBuses.
  std::vector<RadarObservation> radars;  ///< In the order of the configuration.
  OdometryTally odometry;
  std::array<VehicleStatus, kVehicleSignals> vehicle{};  ///< Signals of [vehicle].
};

}  // namespace cremed
