// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/speed_check.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/doubt/radar/acceleration.hpp"
#include "cremed/estimator/doubt/radar/fixed_places.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// A third of PositionSpeed::kStepMps. Radars that look sideways have a larger sigma and are not
/// checked.
constexpr double kMaxSpeedStdMps = 0.3;
/// Smaller differences are explained by the steps of 1 m/s and by acceleration in 0.2 s (10 m/s^2).
constexpr double kMinDifferenceMps = 2.0;
/// Doppler's share of the votes of the best speed that is no contradiction: figures at SpeedCheck.
constexpr double kMaxShareOfBest = 0.6;
/// By how many sigmas Doppler's votes are fewer than the best speed's (Poisson) if contradicted.
constexpr double kMinSigmas = 2.0;
/// Least votes of a contradicting speed, over SpeedSupport::max_chance_votes: the votes of three
/// comparisons are added, so a chance match may count three times. In simulated minutes between
/// smooth walls, of which each scan sees other points, 1 lets 1 of 192 contradict, 1.1 0 of 384.
constexpr double kMinOfChance = 1.1;
/// Of the targets nearer than this to each other only one votes. Without it 980 of 1778 comparisons
/// on RadarScenes 105, with 200 targets a scan, contradict a right Doppler.
constexpr double kMinSpacingM = 1.0;

/// Largest change of the contradicting speed from one comparison to the next: a step of
/// PositionSpeed, and 2 m/s^2. A vehicle has one speed, chance another one each time.
constexpr double kMaxChangeMps = 1.5;

}  // namespace

void SpeedCheck::forget() {
  has_reference_ = false;
  positions_.clear();
  contradictions_ = 0;
  is_contradicted_ = false;
}

void SpeedCheck::add(const TargetSet& targets, std::int64_t stamp_us) {
  const double dt_s = seconds_between(reference_us_, stamp_us);
  const bool is_early = has_reference_ && dt_s >= 0.0 && dt_s < PositionSpeed::kMinIntervalS;
  if (is_early && !is_contradicted_) {
    return;
  }
  has_verdict_ = has_verdict_ && std::abs(seconds_between(verdict_us_, stamp_us)) <= kVerdictValidS;
  const auto speed_mps = take(targets);
  if (is_contradicted_ && speed_mps &&
      is_doppler_step(*speed_mps - last_mps_, seconds_between(last_us_, stamp_us))) {
    forget();  // A fault ends: the comparisons before the step tell nothing of Doppler after it.
  }
  if (speed_mps) {
    last_us_ = stamp_us;
    last_mps_ = *speed_mps;
  }
  if (is_early && has_reference_) {
    return;
  }
  if (speed_mps && has_reference_ && dt_s > 0.0 && dt_s <= PositionSpeed::kMaxIntervalS) {
    const double mean_mps = 0.5 * (reference_mps_ + *speed_mps);
    if (const auto support = positions_.compare(reference_, current_, dt_s, mean_mps)) {
      judge(*support, mean_mps);
      has_verdict_ = true;
      verdict_us_ = stamp_us;
    }
  }
  if (!speed_mps || !(dt_s > 0.0 && dt_s <= PositionSpeed::kMaxIntervalS)) {
    positions_.clear();
  }
  has_reference_ = speed_mps.has_value();
  if (speed_mps) {
    reference_ = current_;
    reference_us_ = stamp_us;
    reference_mps_ = *speed_mps;
  }
}

/// Returns the speed by Doppler, and sets current_ to the targets that are at rest by it.
std::optional<double> SpeedCheck::take(const TargetSet& targets) {
  const auto start = DopplerVelocityEstimator::search(targets);
  const auto velocity = doppler_.fit(targets, start, kArs408DopplerStdMps);
  if (!velocity || std::sqrt(velocity->covariance(0, 0)) > kMaxSpeedStdMps) {
    return std::nullopt;
  }
  take_fixed_places(targets, velocity->velocity_mps, kMinSpacingM, current_);
  return velocity->velocity_mps.x();
}

void SpeedCheck::judge(const SpeedSupport& support, double doppler_mps) {
  const bool is_other = std::abs(support.best_mps - doppler_mps) > kMinDifferenceMps;
  const double excess = support.best_votes - support.given_votes;
  const bool is_supported = support.given_votes >= kMaxShareOfBest * support.best_votes;
  if (is_other && !is_supported && support.best_votes > kMinOfChance * support.max_chance_votes &&
      excess > kMinSigmas * std::sqrt(support.best_votes + support.given_votes)) {
    const bool is_same = std::abs(support.best_mps - other_mps_) <= kMaxChangeMps;
    contradictions_ = is_same || is_contradicted_ ? contradictions_ + 1 : 1;
    other_mps_ = support.best_mps;
  } else if (!is_other || (is_supported && support.given_votes > support.max_chance_votes)) {
    --contradictions_;
  }
  contradictions_ = std::clamp(contradictions_, 0, kMaxContradictions);
  if (contradictions_ == 0 || contradictions_ == kMaxContradictions) {
    is_contradicted_ = contradictions_ != 0;
  }
}

}  // namespace cremed
