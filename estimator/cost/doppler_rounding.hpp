// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace cremed {

// An ARS408 measures Doppler in steps of 0.25 m/s. At a low speed nearly all targets have the same
// step or the next one, so that the speeds of all radars are off by rounding alike: by 0.06 to 0.09
// m/s for 1.5 s where 1094 starts to creep. Targets of more steps average that out.

inline constexpr double kDopplerStepMps = 0.25;
/// Of an error that is uniform within a step: step / sqrt(12).
inline constexpr double kRoundingStdMps = 0.072;

/// Share of the rounding in the error of the speed: 0 at rest, 1 from half a step to two steps, 0
/// from four steps on.
inline double rounding_share(double speed_mps) {
  const double steps = std::abs(speed_mps) / kDopplerStepMps;
  return std::clamp(std::min(2.0 * steps, 2.0 - 0.5 * steps), 0.0, 1.0);
}

}  // namespace cremed
