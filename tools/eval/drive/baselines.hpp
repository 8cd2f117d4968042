// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "daemon/configuration/configuration.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"

namespace cremed {

/// What others make of the same scans, selected and corrected as the configuration says, from one
/// scan of the first radar to the next: "kellner" (kellner_velocity), the mean velocity of both
/// times; "submap" (SubmapOdometry). Without a velocity at both there is no estimate. Throws
/// std::runtime_error if a log cannot be read.
std::vector<RecordedOdometry> baselines(const Configuration& configuration,
                                        const std::vector<std::string>& logs);

}  // namespace cremed
