// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "tools/eval/calibrate/calibration_fit.hpp"
#include "tools/eval/calibrate/noise_factor.hpp"
#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// Factors on the standard deviations that a sensor reports.
struct SensorNoise {
  StdFactor range;
  StdFactor azimuth;
  StdFactor doppler;
};

/// Range and azimuth: of targets found again, moved as `fit` says. Doppler: of a scan's targets
/// against the motion that fits this scan best, as errors that they share are no noise. `before` is
/// what the call before found: where noise is far greater than reported it takes some calls.
SensorNoise measured_noise(const std::vector<RecordedScan>& scans, const CalibrationFit& fit,
                           std::size_t radar, const SensorNoise& before);

}  // namespace cremed
