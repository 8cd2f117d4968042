// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Sets `result` to the targets that are at rest by their Doppler, if the sensor has `velocity_mps`
/// over ground. Of targets nearer than `spacing_m` to each other along both axes only the first is
/// taken: several on one object would vote for all differences of their positions.
void take_fixed_places(const TargetSet& targets, const Eigen::Vector2d& velocity_mps,
                       double spacing_m, TargetSet& result);

}  // namespace cremed
