// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <sstream>
#include <string>

#include "test/data_tests/real_drive.hpp"
#include "test/faults/fault_drive.hpp"

namespace cremed::test {

/// Error of nuScenes' truth itself, as in test_real_drives; up to 60 % larger on 0655 and 0796.
inline TruthNoise nuscenes_truth_noise() {
  return TruthNoise({{0.012, 0.0027, 0.00072, 0.075},
                     {0.021, 0.0048, 0.00104, 0.15},
                     {0.034, 0.0088, 0.00133, 0.3}});
}

/// 0.02 m/s and 0.15 degrees a second (0.1 to 0.2, by scene).
inline WheelStd nuscenes_wheel_std() { return {0.02, 0.0026}; }

/// `duration_s` of a drive's frames from `from_s` on.
inline FaultDrive part_of(FaultDrive drive, double duration_s, double from_s) {
  const std::int64_t from_us = drive.start_us() + std::llround(from_s * 1e6);
  const std::int64_t end_us = from_us + std::llround(duration_s * 1e6);
  std::erase_if(drive.frames, [&](const CanFrame& frame) {
    return frame.stamp_us < from_us || frame.stamp_us > end_us;
  });
  return drive;
}

/// A drive in a folder of the recorded data.
inline FaultDrive recorded_fault_drive(const std::string& name, const std::string& folder,
                                       const Configuration& configuration,
                                       const TruthNoise& noise) {
  std::istringstream truth(read_shared(folder + "/truth.csv"));
  return {name, configuration.radars,
          read_frames(read_shared(folder + "/can.log.xz"), configuration), TrueTrajectory(truth),
          noise};
}

/// Of nuScenes, e.g. "0061".
inline FaultDrive nuscenes_fault_drive(const std::string& scene) {
  const bool is_boston = scene == "0103" || scene == "0655";
  const std::string folder = "data/nuscenes/scene-" + scene;
  FaultDrive drive = recorded_fault_drive(
      "scene-" + scene, folder,
      configuration_of_car(is_boston ? "nuscenes-boston" : "nuscenes-singapore"),
      nuscenes_truth_noise());
  std::istringstream wheels(read_shared(folder + "/wheels.csv"));
  drive.wheels.emplace(wheels, nuscenes_wheel_std());
  return drive;
}

/// Of RadarScenes: sequence 105. `are_flags_used`: whether the sensors' own judgement of what moves
/// is believed.
inline FaultDrive radarscenes_fault_drive(bool are_flags_used) {
  const std::string folder = "data/radarscenes/sequence-105";
  const std::string file = are_flags_used ? "/radarscenes.toml" : "/radarscenes-unflagged.toml";
  return recorded_fault_drive(are_flags_used ? "105" : "105 unflagged", folder,
                              load_configuration(shared_path(folder + file)), TruthNoise());
}

}  // namespace cremed::test
