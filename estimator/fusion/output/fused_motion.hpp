// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// The motion since the output before, in the form of one radar's: an estimate where the odometry
/// is ok or standing_still. Otherwise initialising is told as no_reference, predicted and lost as
/// gap_too_long, ambiguous as itself. standing_still is ok if the mean speed was above
/// `standstill_mps`: it came to a stop. `targets`: in the scan that it ends with.
EgoMotion fused_motion(const Odometry& odometry, std::size_t targets, double standstill_mps);

}  // namespace cremed
