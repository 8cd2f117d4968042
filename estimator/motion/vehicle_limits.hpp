// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// Limits of a road vehicle: tyres hold 1 g, and a yaw rate of 0.6 rad/s (a tight turn) takes at
/// least 0.3 s.
inline constexpr double kMaxAccelerationMps2 = 10.0;
inline constexpr double kMaxYawAccelerationRadps2 = 2.0;

}  // namespace cremed
