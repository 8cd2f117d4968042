// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/position_speed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cremed/estimator/doubt/radar/side_gate.hpp"

namespace cremed {
namespace {

/// Half of this step moves a target at 40 m by 0.6 m in 0.3 s.
constexpr double kYawRateStepRadps = 0.1;
/// In standard deviations of the expected number of chance votes plus one. False-alarm rate: 1 % of
/// pairs of unrelated scans (Poisson, 0.3 to 0.5 votes expected in each of 448 cells).
constexpr double kChanceSigmas = 4.0;

/// Votes of a speed and its two neighbours, which allows for noise of positions and acceleration.
template <typename Votes>
double votes_around(const Votes& votes, std::size_t step) {
  const std::size_t first = step == 0 ? 0 : step - 1;
  const std::size_t last = std::min(step + 2, votes.size());
  return std::accumulate(votes.begin() + static_cast<std::ptrdiff_t>(first),
                         votes.begin() + static_cast<std::ptrdiff_t>(last), 0);
}

}  // namespace

/// The targets that can pass the side gate, sorted from right to left.
PositionSpeed::Places PositionSpeed::sort_by_side(const TargetSet& previous) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(previous.size(), kMaxTargets); ++i) {
    const Target& target = previous[i];
    if (target.covariance_m2.yy <= kMaxSideVarianceM2) {
      places_[count++] = {target.x_m, target.y_m, target.covariance_m2.yy};
    }
  }
  std::sort(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Place& a, const Place& b) { return a.y_m < b.y_m; });
  return {places_.data(), count};
}

void PositionSpeed::count(Places previous, const TargetSet& current, double dt_s,
                          double yaw_rate_radps, Votes& votes) {
  votes.fill(0);
  const double c = std::cos(yaw_rate_radps * dt_s);
  const double s = std::sin(yaw_rate_radps * dt_s);
  const double steps_per_m = 1.0 / (dt_s * kStepMps);
  for (std::size_t i = 0; i < std::min(current.size(), kMaxTargets); ++i) {
    const Target& target = current[i];
    const double x_m = c * target.x_m - s * target.y_m;
    const double y_m = s * target.x_m + c * target.y_m;
    const auto first =
        std::lower_bound(previous.begin(), previous.end(), y_m - kMaxSideGateM,
                         [](const Place& place, double lowest_m) { return place.y_m < lowest_m; });
    for (auto place = first; place != previous.end() && place->y_m <= y_m + kMaxSideGateM;
         ++place) {
      const double step = (place->x_m - x_m) * steps_per_m - kMinSpeedMps / kStepMps + 0.5;
      if (step >= 0.0 && step < static_cast<double>(kSteps) &&
          is_within_side_gate(place->y_m - y_m,
                              target.covariance_m2.yy + place->side_variance_m2)) {
        ++votes[static_cast<std::size_t>(step)];
      }
    }
  }
}

SpeedSupport PositionSpeed::sum_up() const {
  SpeedSupport support;
  for (std::size_t k = 0; k < kYawRates; ++k) {
    double given = 0.0;
    for (const Pair& pair : pairs_) {
      given += votes_around(pair.votes[k], pair.given_step);
    }
    support.given_votes = std::max(support.given_votes, given);
    double sum = 0.0;
    bool is_best = false;
    for (std::size_t step = 0; step < kSteps; ++step) {
      double votes = 0.0;
      for (const Pair& pair : pairs_) {
        votes += votes_around(pair.votes[k], step);
      }
      sum += votes;
      if (votes > support.best_votes) {
        support.best_votes = votes;
        support.best_mps = kMinSpeedMps + static_cast<double>(step) * kStepMps;
        is_best = true;
      }
    }
    if (is_best) {
      const double chance = sum / static_cast<double>(kSteps);
      support.max_chance_votes = chance + kChanceSigmas * std::sqrt(chance + 1.0);
    }
  }
  return support;
}

std::optional<SpeedSupport> PositionSpeed::compare(const TargetSet& previous,
                                                   const TargetSet& current, double dt_s,
                                                   double given_mps) {
  const double given_step = std::round((given_mps - kMinSpeedMps) / kStepMps);
  if (!(given_step >= 0.0 && given_step < static_cast<double>(kSteps))) {
    return std::nullopt;
  }
  newest_ = (newest_ + 1) % kPairs;
  Pair& pair = pairs_[newest_];
  pair.given_step = static_cast<std::size_t>(given_step);
  const Places places = sort_by_side(previous);
  for (std::size_t k = 0; k < kYawRates; ++k) {
    constexpr std::size_t kMiddle = kYawRates / 2;
    const double steps = static_cast<double>(k) - static_cast<double>(kMiddle);
    count(places, current, dt_s, steps * kYawRateStepRadps, pair.votes[k]);
  }
  const SpeedSupport support = sum_up();
  return support.best_votes > support.max_chance_votes ? std::optional(support) : std::nullopt;
}

}  // namespace cremed
