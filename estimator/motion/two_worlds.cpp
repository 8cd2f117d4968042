// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/motion/two_worlds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cremed {
namespace {

/// Least number of places of a rival speed, and its least ratio to the places that fit.
struct RivalLimits {
  std::size_t places;
  double share;
};
/// More than the places of one truck (three to five), and more than the usual share of moving
/// targets (5 %: DopplerOptions::moving_weight).
constexpr RivalLimits kRivalLimits{5, 0.25};
/// Lower limits while in doubt (hysteresis), for a rival that is half hidden in a scan.
constexpr RivalLimits kRivalLimitsInDoubt{3, 0.1};

/// Rivals nearer than this to the vehicle's speed are the tails of the static world: 2674 of 2677
/// doubts on RadarScenes 105, with 200 targets a scan, were 0.1 to 0.8 m/s beside it.
constexpr double kMinDifferenceMps = 1.0;
/// The same relative to the speed. The tails stem from errors of bearings and so are proportional
/// to the speed: at rest there are none, and a train that starts alongside differs by less.
constexpr double kMinDifferenceShare = 0.15;

}  // namespace

bool TwoWorlds::is_rival(const SpeedVotes& votes) const {
  const RivalLimits& limits = is_in_doubt() ? kRivalLimitsInDoubt : kRivalLimits;
  const double faster_mps = std::max(std::abs(votes.rival_mps), std::abs(votes.own_mps));
  const double least_mps = std::min(kMinDifferenceMps, kMinDifferenceShare * faster_mps);
  return std::abs(votes.rival_mps - votes.own_mps) >= least_mps && votes.rival >= limits.places &&
         static_cast<double>(votes.rival) >= limits.share * static_cast<double>(votes.own);
}

}  // namespace cremed
