// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace cremed {

/// What a road vehicle does not exceed.
inline constexpr double kMaxAccelerationMps2 = 10.0;
inline constexpr double kMaxYawAccelerationRadps2 = 2.0;

}  // namespace cremed
