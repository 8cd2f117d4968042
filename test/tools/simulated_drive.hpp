// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "daemon/source/candump.hpp"
#include "tools/simulate/simulation.hpp"

namespace cremed::test {

inline const Scenario& scenario(std::string_view name) {
  const Scenario* found = find_scenario(name);
  if (found == nullptr) throw std::invalid_argument("no scenario of that name");
  return *found;
}

inline RadarConfiguration radar(const std::string& name, const std::string& interface,
                                const Pose2& vehicle_from_radar, const RadarSettings& decoder) {
  RadarConfiguration result;
  result.name = name;
  result.interface = interface;
  result.decoder = decoder;
  result.ego_motion.vehicle_from_radar = vehicle_from_radar;
  result.ego_motion.correction.rotation_lead_s = decoder.rotation_lead_s().value_or(0.0);
  return result;
}

/// One radar of each kind, with mounts that reveal sign errors.
inline std::vector<RadarConfiguration> one_of_each_kind() {
  Ars408Options objects;
  objects.sensor_id = 3;
  objects.output = Ars408Output::objects;
  BoschGprOptions inverted;
  inverted.base_id = 0x480;
  inverted.invert_azimuth = true;
  inverted.invert_doppler = true;
  return {radar("clusters", "can0", {3.4, 0.5, 0.6}, Ars408Options{}),
          radar("gpr", "can1", {-0.9, -0.6, std::numbers::pi - 0.5}, BoschGprOptions{}),
          radar("objects", "can2", {3.4, -0.5, -1.2}, objects),
          radar("inverted", "can3", {0.5, 0.8, 1.4}, inverted)};
}

/// Without unknown errors: mounts and Doppler scale are exact.
inline SimulationOptions exactly_mounted(SimulationOptions options) {
  options.mount_yaw_std_rad = 0.0;
  options.mount_position_std_m = 0.0;
  options.doppler_scale_std = 0.0;
  return options;
}

/// A whole drive in memory.
struct Drive {
  std::vector<RadarConfiguration> radars;
  std::vector<CanFrame> frames;
  std::vector<ScanTruth> truths;  ///< In order of their stamps.
  std::vector<Pose2> mounts;      ///< True mounts.
  std::vector<std::string> interfaces;
  std::string truth_csv;

  /// The frames as candump text.
  [[nodiscard]] std::string log() const {
    std::string text;
    for (const CanFrame& frame : frames) text += candump_line(frame, interfaces[frame.interface]);
    return text;
  }
};

inline Drive drive(const Scenario& scenario, const std::vector<RadarConfiguration>& radars,
                   const SimulationOptions& options) {
  Drive result;
  result.radars = radars;
  Simulation simulation(scenario, radars, options,
                        [&](const ScanTruth& truth) { result.truths.push_back(truth); });
  while (const auto frame = simulation.next()) {
    result.frames.push_back(*frame);
  }
  result.interfaces = simulation.interfaces();
  result.mounts = simulation.mounts();
  result.truth_csv = simulation.truth_csv();
  return result;
}

/// The scans that the daemon decodes from the log for one radar.
struct DecodedRadar {
  std::vector<RadarScan> scans;
  DecoderCounters decoder;
  AssemblerCounters assembler;
};

inline DecodedRadar decode(const std::string& log, const RadarConfiguration& radar) {
  const auto decoder = radar.decoder.make_decoder();
  ScanAssembler assembler(*decoder, 50'000);
  DecodedRadar result;
  const auto take = [&] {
    while (const RadarScan* scan = assembler.next()) result.scans.push_back(*scan);
  };
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const CandumpLine parsed = parse_candump_line(line);
    if (parsed.status != CandumpStatus::frame) throw std::runtime_error("bad line: " + line);
    if (parsed.interface_name != radar.interface) continue;
    assembler.add(decoder->decode(parsed.frame));
    take();
  }
  assembler.finish();
  take();
  result.decoder = decoder->counters();
  result.assembler = assembler.counters();
  return result;
}

/// The truth file, interpolated linearly as in cremed-eval.
class TruthTable {
 public:
  explicit TruthTable(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    char comma = 0;
    Row row;
    while (lines >> row.stamp_us >> comma >> row.pose.x_m >> comma >> row.pose.y_m >> comma >>
           row.pose.yaw_rad) {
      rows_.push_back(row);
    }
  }

  [[nodiscard]] Pose2 at(double stamp_us) const {
    const auto after = std::lower_bound(
        rows_.begin() + 1, rows_.end() - 1, stamp_us,
        [](const Row& row, double stamp) { return static_cast<double>(row.stamp_us) < stamp; });
    const Row& a = *(after - 1);
    const Row& b = *after;
    const double share =
        (stamp_us - static_cast<double>(a.stamp_us)) / static_cast<double>(b.stamp_us - a.stamp_us);
    return {a.pose.x_m + share * (b.pose.x_m - a.pose.x_m),
            a.pose.y_m + share * (b.pose.y_m - a.pose.y_m),
            a.pose.yaw_rad + share * (b.pose.yaw_rad - a.pose.yaw_rad)};
  }

  struct Row {
    std::int64_t stamp_us = 0;
    Pose2 pose;
  };
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

 private:
  std::vector<Row> rows_;
};

}  // namespace cremed::test
