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

/// Result of a recorded drive for one radar. Offset, stamp and factors are relative to the
/// configured ones.
struct RadarCalibration {
  FittedRadar free;  ///< With all states unknown.
  FittedRadar fit;   ///< With the configured value held where it is not improved.
  /// false: the configured value was kept.
  std::array<bool, kCalibrationStates> is_changed{};
  SensorNoise noise;
  std::size_t scans = 0;
};

struct Calibration {
  std::vector<RadarCalibration> radars;
  FittedVehicle vehicle;
};

/// Calibrates all radars of the configuration together. With `truth`, mounts are in its frame and
/// the rolling direction is estimated. If `truth` is null, mounts are relative to the rolling
/// direction, and y, stamps and scale relative to the first radar's. Throws std::runtime_error.
Calibration calibrate(const Configuration& configuration, const std::vector<std::string>& logs,
                      const TrueTrajectory* truth);

/// The configuration with the results.
Configuration calibrated(const Configuration& configuration,
                         const std::vector<RadarCalibration>& calibrations);

}  // namespace cremed
