// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/motion/two_worlds.hpp"

#include <cstddef>

namespace cremed {
namespace {

/// Another speed is a rival in at least so many places and so large a share of those that fit.
struct RivalLimits {
  std::size_t places;
  double share;
};
/// More than one truck has (three to five places), and more than the movers that are among the
/// targets of any drive (5 %: DopplerOptions::moving_weight).
constexpr RivalLimits kRival{5, 0.25};
/// What is left of that where a half of it is hidden for a scan: the doubt does not flicker.
constexpr RivalLimits kRivalInDoubt{3, 0.1};

}  // namespace

bool TwoWorlds::is_rival(const SpeedVotes& votes) const {
  const RivalLimits& limits = is_in_doubt() ? kRivalInDoubt : kRival;
  return votes.rival >= limits.places &&
         static_cast<double>(votes.rival) >= limits.share * static_cast<double>(votes.own);
}

}  // namespace cremed
