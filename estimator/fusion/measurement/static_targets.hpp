// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Sets `result` to the targets of a scan, `age_s` older than the state, whose Doppler is within
/// static_doppler_mps of that of a target at rest.
void select_static(const OdometryState& state, std::size_t radar, double age_s,
                   const TargetSet& targets, TargetSet& result);

}  // namespace cremed
