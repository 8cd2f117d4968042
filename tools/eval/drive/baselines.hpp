// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/recorded_drive.hpp"

namespace cremed {

/// Other methods on the same scans, selected and corrected as configured, from one scan of the
/// first radar to the next: "kellner" (kellner_velocity), the mean of the velocities at both times;
/// "submap" (SubmapOdometry of ten sweeps) and "submap_80" (of 80). No estimate without a velocity
/// at both times.
std::vector<RecordedOdometry> baselines(const Configuration& configuration,
                                        const std::vector<RecordedRadar>& radars);

}  // namespace cremed
