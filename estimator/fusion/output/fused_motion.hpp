// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// The motion since the previous output as an EgoMotion: an estimate if the odometry is ok or
/// standing_still. initialising becomes no_reference, predicted and lost become gap_too_long, and
/// ambiguous is kept. standing_still becomes ok if the mean speed was above `standstill_mps` (the
/// vehicle stopped). An estimate becomes implausible if a scan corrected a pose of large sigma by
/// more than a vehicle drives since the scan of another radar, which may be a millisecond before.
/// `targets`: number in the scan at its end.
EgoMotion fused_motion(const Odometry& odometry, std::size_t targets, double standstill_mps);

}  // namespace cremed
