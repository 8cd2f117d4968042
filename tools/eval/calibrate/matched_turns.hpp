// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/eval/calibrate/calibration_fit.hpp"
#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// Yaw rates of a radar, of kMatchedTurn, from targets found again five scans later: the mean of
/// the azimuths by which they miss their places by the fitted motion. Only static targets without a
/// neighbour are compared, where the sensor reports them: a fit of the azimuth scale that minimised
/// distances of targets would collapse all azimuths. `azimuth_std_factor` is the noise of azimuths
/// over the reported one.
std::vector<YawRateMeasurement> matched_turns(const std::vector<RecordedScan>& scans,
                                              const CalibrationFit& fit, std::size_t radar,
                                              double azimuth_std_factor);

/// Motion of a radar, in its frame, by the fit, at most 0.5 s.
std::optional<Pose2> radar_motion(const CalibrationFit& fit, std::size_t radar,
                                  std::int64_t begin_us, std::int64_t end_us);

}  // namespace cremed
