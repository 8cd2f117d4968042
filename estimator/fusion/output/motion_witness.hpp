// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// Whether no vehicle could have moved as one radar says, given what the odometry knew up to 0.3 s
/// before: their speeds or yaw rates differ by more than 5 sigma of both and what 10 m/s^2 or
/// 2 rad/s^2 do in between. Five sigma alone are exceeded by chance once in two million motions.
/// Also by an odometry that is ambiguous: of two candidates none is to be published.
bool contradicts(const Odometry& known, const EgoMotion& motion);

/// The motion without its estimate, ambiguous: it fits its scans, and is not the vehicle's.
EgoMotion withdrawn(EgoMotion motion);

}  // namespace cremed
