// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "tools/eval/calibrate/calibration_fit.hpp"
#include "tools/eval/calibrate/noise_factor.hpp"
#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// Factors on the standard deviations reported by a sensor.
struct SensorNoise {
  StdFactor range;
  StdFactor azimuth;
  StdFactor doppler;
};

/// Range and azimuth: of targets found again, with the motion of `fit`. Doppler: of a scan's
/// targets against the motion that fits this scan best, which removes shared errors. `before` is
/// the result of the last call: much larger noise than reported takes several calls.
SensorNoise measured_noise(const std::vector<RecordedScan>& scans, const CalibrationFit& fit,
                           std::size_t radar, const SensorNoise& before);

}  // namespace cremed
