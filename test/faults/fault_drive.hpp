// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "test/tools/pipeline_bench.hpp"
#include "tools/eval/drive/truth_noise.hpp"

namespace cremed::test {

/// A healthy drive into which faults are injected. Each radar has its own bus: CanFrame::interface
/// is the radar's index.
struct FaultDrive {
  std::string name;
  std::vector<RadarConfiguration> radars;
  std::vector<CanFrame> frames;
  TrueTrajectory truth;
  TruthNoise truth_noise;

  [[nodiscard]] std::int64_t start_us() const { return frames.front().stamp_us; }
  [[nodiscard]] double duration_s() const {
    return static_cast<double>(frames.back().stamp_us - start_us()) * 1e-6;
  }
  /// A lateral radar: the odometry needs others too.
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

inline FaultDrive simulated_fault_drive(
    const std::string& name, double duration_s,
    const std::vector<RadarConfiguration>& radars = four_radars()) {
  SimulationOptions options;
  options.seed = 1;
  options.duration_s = duration_s;
  const Drive simulated = drive(scenario(name), radars, options);
  return {name, simulated.radars, simulated.frames, truth_of(simulated), TruthNoise()};
}

}  // namespace cremed::test
