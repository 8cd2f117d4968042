// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "tools/eval/calibrate/calibration_fit.hpp"
#include "tools/eval/calibrate/sensor_noise.hpp"
#include "tools/eval/drive/true_trajectory.hpp"

namespace cremed {

/// What a recorded drive says about a radar. Offset, stamp and factors are on top of those that the
/// configuration has.
struct RadarCalibration {
  FittedRadar free;  ///< With all states unknown.
  FittedRadar fit;   ///< With the configured value where the drive does not say better.
  /// false: the configured value was kept.
  std::array<bool, kCalibrationStates> is_changed{};
  SensorNoise noise;
  std::size_t scans = 0;
};

struct Calibration {
  std::vector<RadarCalibration> radars;
  FittedVehicle vehicle;
};

/// Calibrates all radars of the configuration together. With `truth`, mounts are in its frame, and
/// the direction the vehicle rolls in is found as well. It may be null: then mounts are relative to
/// that direction, and the first radar's y, stamps and scale are what those of the others are
/// compared with. Throws std::runtime_error.
Calibration calibrate(const Configuration& configuration, const std::vector<std::string>& logs,
                      const TrueTrajectory* truth);

/// The configuration with what was found.
Configuration calibrated(const Configuration& configuration,
                         const std::vector<RadarCalibration>& calibrations);

}  // namespace cremed
