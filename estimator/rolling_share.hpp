// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace cremed {

/// How much of the errors that motion makes shows at a speed: 0 when the vehicle stands, 1 when it
/// drives. Slower than 0.2 m/s its body comes to rest.
inline double rolling_share(double speed_mps) {
  constexpr double kRollingMps = 0.2;
  return std::min(std::abs(speed_mps) / kRollingMps, 1.0);
}

}  // namespace cremed
