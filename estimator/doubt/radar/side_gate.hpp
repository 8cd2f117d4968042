// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

/// The side gate is at most 1.2 m wide, less than half a lane.
inline constexpr double kMaxSideVarianceM2 = 0.6 * 0.6;
inline constexpr double kSideGateSigmas = 2.0;
inline constexpr double kMaxSideGateM = 1.2;

/// Whether targets of two scans may be the same, by their distance across the way and its variance.
/// Rejects 5 % of true pairs, and all pairs whose distance is so uncertain that a target in the
/// next lane would pass.
inline bool is_within_side_gate(double across_m, double variance_m2) {
  return variance_m2 <= kMaxSideVarianceM2 &&
         squared(across_m) <= squared(kSideGateSigmas) * variance_m2;
}

}  // namespace cremed
