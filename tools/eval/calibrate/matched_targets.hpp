// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "cremed/estimator/scan/pose2.hpp"
#include "tools/eval/calibrate/noise_factor.hpp"
#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// Errors of targets found in two scans, in standard deviations of both.
struct MatchErrors {
  std::vector<ScaledError> range;
  std::vector<ScaledError> azimuth;
  std::vector<double> azimuth_std_rad;  ///< Of both, as assumed: the unit of `azimuth`.
};

/// Factors on reported standard deviations.
struct AssumedFactors {
  double range = 1.0;
  double azimuth = 1.0;
};

/// Adds the errors of pairs without another candidate in the gate. `motion` is the pose of the
/// radar at the current scan in its frame at the previous one.
void add_match_errors(const RecordedScan& previous, const RecordedScan& current,
                      const Pose2& motion, const AssumedFactors& assumed, MatchErrors& errors);

}  // namespace cremed
