// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/motion/position_speed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

/// Bounds the work: a scan's first targets are an ARS408's nearest, which are known best.
constexpr std::size_t kMaxTargets = 96;
/// A pair is straight ahead within kGateSigmas of this, 1.2 m: less than half a lane, so that what
/// stands in the next one does not vote.
constexpr double kMaxSideStdM = 0.6;
/// Half of the step between yaw rates turns a target at 40 m by 0.6 m in 0.3 s.
constexpr double kYawRateStepRadps = 0.1;
/// 5 % of true pairs are outside.
constexpr double kGateSigmas = 2.0;
/// Of votes by chance, one more than expected. Exceeded in 1 % of pairs of scans that have nothing
/// in common (Poisson, 0.3 to 0.5 votes expected at each of 448 places).
constexpr double kStandsOutSigmas = 4.0;

/// Of a speed and its neighbours, which scatter of positions and acceleration reach.
template <typename Votes>
double votes_around(const Votes& votes, std::size_t step) {
  const std::size_t first = step == 0 ? 0 : step - 1;
  const std::size_t last = std::min(step + 2, votes.size());
  return std::accumulate(votes.begin() + static_cast<std::ptrdiff_t>(first),
                         votes.begin() + static_cast<std::ptrdiff_t>(last), 0);
}

}  // namespace

void PositionSpeed::count(const TargetSet& previous, const TargetSet& current, double dt_s,
                          double yaw_rate_radps, Votes& votes) {
  votes.fill(0);
  const double c = std::cos(yaw_rate_radps * dt_s);
  const double s = std::sin(yaw_rate_radps * dt_s);
  const double steps_per_m = 1.0 / (dt_s * kStepMps);
  const std::size_t n = std::min(previous.size(), kMaxTargets);
  for (std::size_t i = 0; i < std::min(current.size(), kMaxTargets); ++i) {
    const Target& target = current[i];
    const double x_m = c * target.x_m - s * target.y_m;
    const double y_m = s * target.x_m + c * target.y_m;
    for (std::size_t j = 0; j < n; ++j) {
      const double variance = target.covariance_m2.yy + previous[j].covariance_m2.yy;
      const double step = (previous[j].x_m - x_m) * steps_per_m - kLeastMps / kStepMps + 0.5;
      if (variance <= squared(kMaxSideStdM) && step >= 0.0 && step < static_cast<double>(kSteps) &&
          squared(previous[j].y_m - y_m) <= squared(kGateSigmas) * variance) {
        ++votes[static_cast<std::size_t>(step)];
      }
    }
  }
}

SpeedSupport PositionSpeed::sum_up() const {
  SpeedSupport support;
  double chance = 0.0;
  for (std::size_t k = 0; k < kYawRates; ++k) {
    double asked = 0.0;
    for (const Pair& pair : pairs_) {
      asked += votes_around(pair.votes[k], pair.asked);
    }
    support.asked = std::max(support.asked, asked);
    for (std::size_t step = 0; step < kSteps; ++step) {
      double votes = 0.0;
      for (const Pair& pair : pairs_) {
        votes += votes_around(pair.votes[k], step);
      }
      chance += votes / static_cast<double>(kSteps * kYawRates);
      if (votes > support.best) {
        support.best = votes;
        support.best_mps = kLeastMps + static_cast<double>(step) * kStepMps;
      }
    }
  }
  support.by_chance = chance + kStandsOutSigmas * std::sqrt(chance + 1.0);
  return support;
}

std::optional<SpeedSupport> PositionSpeed::compare(const TargetSet& previous,
                                                   const TargetSet& current, double dt_s,
                                                   double asked_mps) {
  const double asked_step = std::round((asked_mps - kLeastMps) / kStepMps);
  if (!(asked_step >= 0.0 && asked_step < static_cast<double>(kSteps))) {
    return std::nullopt;
  }
  newest_ = (newest_ + 1) % kPairs;
  Pair& pair = pairs_[newest_];
  pair.asked = static_cast<std::size_t>(asked_step);
  for (std::size_t k = 0; k < kYawRates; ++k) {
    constexpr std::size_t kMiddle = kYawRates / 2;
    const double steps = static_cast<double>(k) - static_cast<double>(kMiddle);
    count(previous, current, dt_s, steps * kYawRateStepRadps, pair.votes[k]);
  }
  const SpeedSupport support = sum_up();
  return support.best > support.by_chance ? std::optional(support) : std::nullopt;
}

}  // namespace cremed
