// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/doubt/vehicle/motion_evidence.hpp"
#include "cremed/estimator/fusion/state/radar_set.hpp"

namespace cremed {

/// Largest decrease of chi-square by leaving out one radar (2 to 4 measurements) of a consistent
/// set. Healthy drives have 4.6 at most (nuScenes 0061, 0103, 0655, 0796, 1094, RadarScenes 105); a
/// Doppler scale of 0.95 has 18 to 84, a mount 5 degrees off 22 to 35, a mirrored front radar 26 to
/// 600 in turns.
inline constexpr double kMaxDecrease = 8.0;

/// The set of radars that is believed.
struct ConsistentSet {
  RadarSet radars = 0;  ///< 0: no set is consistent.
  double chi_square = 0.0;
  int rivals = 0;  ///< Consistent sets of the same size that fit as well.
  /// No set is consistent, but all radars agree on a slip that no vehicle has.
  bool agrees_on_slip = false;
  /// Two radars with each other's mounts would explain all measurements as well.
  bool is_exchange_possible = false;
};

/// Whether leaving out any one radar of the set lowers chi-square by kMaxDecrease at most, by half
/// of that if the radar is at fault already. A single radar is compared with its own positions and
/// with the radars that look sideways.
bool is_consistent(const MotionEvidence& evidence, RadarSet set, RadarSet at_fault);

/// Whether several radars are consistent with each other, with half of kMaxDecrease, if the vehicle
/// may have any slip: it skids, or their mounts are turned alike.
bool agree_on_slip(const MotionEvidence& evidence, RadarSet set);

/// With which sets the vehicle would slip as none does.
struct SlipRule {
  double max_decrease = kDecreaseByImpossibleSlip;  ///< Of chi-square of a set by any slip.
  bool may_be_common = true;  ///< ConsistentSet::agrees_on_slip is looked for.
};

/// The first of these sets that is consistent, unless the vehicle would slip as none does:
/// - all radars;
/// - all that are not at fault;
/// - all but one or two; or a single radar. Of several that are consistent the one that fits best.
///
/// Two sets may replace it: a smaller one, if the witnesses contradict it; and all but two radars,
/// if all measurements fit with these two at each other's mounts.
ConsistentSet find_consistent_set(const MotionEvidence& evidence, RadarSet at_fault,
                                  const SlipRule& slip);

}  // namespace cremed
