// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/doubt/vehicle/motion_evidence.hpp"
#include "cremed/estimator/doubt/vehicle/radar_set.hpp"

namespace cremed {

/// Largest decrease of chi-square by leaving out a radar, of 2 to 4 measurements. Healthy drives
/// have 4.6 at most (nuScenes 0061, 0103, 0655, 0796, 1094, RadarScenes 105); a Doppler scale of
/// 0.95 has 18 to 84, a mount 5 degrees off 22 to 35, a mirrored front radar 26 to 600 in turns.
inline constexpr double kMaxDecrease = 8.0;

/// The set of radars that is believed.
struct ConsistentSet {
  RadarSet radars = 0;  ///< None: no set is consistent.
  double chi_square = 0.0;
  int rivals = 0;  ///< Consistent sets of the same size that fit as well.
  /// Two radars with each other's mounts would explain all as well.
  bool is_exchange_possible = false;
};

/// Leaving out none of the set lowers its chi-square by more than kMaxDecrease, half of that for
/// one that is at fault already. A single radar is compared with its own positions, and with those
/// that look sideways.
bool is_consistent(const MotionEvidence& evidence, RadarSet set, RadarSet at_fault);

/// All radars if they are consistent, else those that are not two with each other's mounts, if that
/// alone explains all; else those of before; else the largest sets that are, with
/// one or two radars less or of one radar.
ConsistentSet find_consistent_set(const MotionEvidence& evidence, RadarSet at_fault);

}  // namespace cremed
