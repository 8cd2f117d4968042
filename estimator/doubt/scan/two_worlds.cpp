// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/scan/two_worlds.hpp"

#include <cmath>
#include <cstddef>

namespace cremed {
namespace {

/// Least number of places of a rival speed, and its least ratio to those of the estimated speed.
struct RivalLimits {
  std::size_t places;
  double share;
};
/// More than the places of one truck (three to five), and more than the usual share of moving
/// targets (5 %: DopplerOptions::moving_weight).
constexpr RivalLimits kRivalLimits{5, 0.25};
/// Lower limits while in doubt (hysteresis), for a rival that is half hidden in a scan.
constexpr RivalLimits kRivalLimitsInDoubt{3, 0.1};
/// Least ratio of the targets, if the rival is slower. Cars that drive along on a motorway, which
/// would rest if the vehicle did, have 0.04 to 0.14 times the targets of guard rails, but up to 0.7
/// times their places (20 scans of RadarScenes 105 without its flags).
constexpr double kMinShareOfTargets = 0.15;

/// Nearer rivals are the tails of the static world: errors of azimuth spread its Doppler in
/// proportion to the speed. 2674 of 2677 doubts of RadarScenes 105, with 200 targets a scan at 15
/// to 25 m/s, were by rivals 0.1 to 0.8 m/s beside the vehicle's speed.
constexpr double kMinDifferenceShare = 0.05;

}  // namespace

bool TwoWorlds::is_rival(const SpeedVotes& votes) const {
  const RivalLimits& limits = is_in_doubt() ? kRivalLimitsInDoubt : kRivalLimits;
  const double least_targets =
      votes.is_rival_slower() ? kMinShareOfTargets * static_cast<double>(votes.own_targets) : 0.0;
  return std::abs(votes.rival_mps - votes.own_mps) >=
             kMinDifferenceShare * std::abs(votes.own_mps) &&
         votes.rival >= limits.places &&
         static_cast<double>(votes.rival) >= limits.share * static_cast<double>(votes.own) &&
         static_cast<double>(votes.rival_targets) >= least_targets;
}

}  // namespace cremed
