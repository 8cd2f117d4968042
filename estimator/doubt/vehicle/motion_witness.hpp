// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/fusion/state/odometry.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

namespace cremed {

/// Whether the motion of one radar contradicts the odometry of up to 0.3 s before: speeds or yaw
/// rates differ by more than 5 sigma of both (false-alarm rate 1 in two million motions) plus the
/// change by 10 m/s^2 or 2 rad/s^2 in between. An ambiguous odometry counts too: neither it nor the
/// motion is then published as true.
bool contradicts(const Odometry& known, const EgoMotion& motion);

/// The motion without its estimate, with status ambiguous.
EgoMotion withdrawn(EgoMotion motion);

}  // namespace cremed
