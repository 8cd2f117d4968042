// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

/// Whether two targets of two scans may be one, by their distance across the way and its variance.
/// 5 % of true pairs are rejected, and all whose distance is so uncertain that a target in the next
/// lane would pass: the gate is at most 1.2 m wide, less than half a lane.
inline bool is_within_side_gate(double across_m, double variance_m2) {
  constexpr double kMaxSideStdM = 0.6;
  constexpr double kGateSigmas = 2.0;
  return variance_m2 <= squared(kMaxSideStdM) &&
         squared(across_m) <= squared(kGateSigmas) * variance_m2;
}

}  // namespace cremed
