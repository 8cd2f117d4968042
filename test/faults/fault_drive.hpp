// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "test/tools/pipeline_bench.hpp"
#include "tools/eval/drive/truth_noise.hpp"
#include "tools/eval/drive/wheel_reference.hpp"

namespace cremed::test {

/// A healthy drive into which faults are injected. Each radar has its own bus: CanFrame::interface
/// is the radar's index.
struct FaultDrive {
  std::string name;
  std::vector<RadarConfiguration> radars;
  std::vector<CanFrame> frames;
  TrueTrajectory truth;
  TruthNoise truth_noise;
  /// A second reference, if recorded: a pose is wrong if both say so. Truth has errors of its own
  /// that grow with time: against the wheels over 2.2 s 0.11 m on nuScenes 1094 (0.06 m on 0061),
  /// three times its noise over 0.3 s. There 9 poses of the healthy drive and up to 50 with a fault
  /// are beyond 5 sigma of truth, all within 1.1 sigma of wheels and gyro.
  std::optional<WheelReference> wheels{};

  [[nodiscard]] std::int64_t start_us() const { return frames.front().stamp_us; }
  [[nodiscard]] double duration_s() const {
    return static_cast<double>(frames.back().stamp_us - start_us()) * 1e-6;
  }
  /// A lateral radar, 60 degrees or more off the vehicle's axis.
  [[nodiscard]] bool is_side(std::size_t radar) const {
    return std::abs(std::cos(radars[radar].ego_motion.vehicle_from_radar.yaw_rad)) < 0.5;
  }
};

/// The demo's car with an additional ARS408 on each side.
inline std::vector<RadarConfiguration> four_radars() {
  std::vector<RadarConfiguration> radars = default_radars();
  radars.push_back(radar("left", "can2", {2.4, 0.8, 1.56}, Ars408Options{}));
  radars.push_back(radar("right", "can3", {2.4, -0.8, -1.56}, Ars408Options{}));
  return radars;
}

/// Only the radars of a list with commas; of an empty one all.
inline FaultDrive with_radars(FaultDrive drive, const std::string& names) {
  if (names.empty()) return drive;
  std::vector<RadarConfiguration> kept;
  std::vector<int> index;
  for (const RadarConfiguration& radar : drive.radars) {
    const bool is_kept = ("," + names + ",").find("," + radar.name + ",") != std::string::npos;
    index.push_back(is_kept ? static_cast<int>(kept.size()) : -1);
    if (is_kept) kept.push_back(radar);
  }
  if (kept.size() != 1U + static_cast<std::size_t>(std::ranges::count(names, ','))) {
    std::string known;
    for (const RadarConfiguration& radar : drive.radars) known += " " + radar.name;
    throw std::runtime_error("radars: " + names + ": must be some of" + known);
  }
  drive.radars = kept;
  std::erase_if(drive.frames, [&](const CanFrame& frame) { return index[frame.interface] < 0; });
  for (CanFrame& frame : drive.frames) {
    frame.interface = static_cast<std::uint8_t>(index[frame.interface]);
  }
  return drive;
}

inline FaultDrive simulated_fault_drive(
    const std::string& name, double duration_s,
    const std::vector<RadarConfiguration>& radars = four_radars(), std::uint64_t seed = 1) {
  SimulationOptions options;
  options.seed = seed;
  options.duration_s = duration_s;
  const Drive simulated = drive(scenario(name), radars, options);
  return {name, simulated.radars, simulated.frames, truth_of(simulated), TruthNoise()};
}

}  // namespace cremed::test
