// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/common_scale.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cremed/estimator/doubt/vehicle/consistent_set.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// An error that all radars share is found by the own check of each within this time.
constexpr double kFoundByAllS = 5.0;
/// With 0.85 the maps still find the targets again; what was learned can be taken back.
constexpr double kMinFactorOfAll = 0.85;
/// Of three radars or more, epochs that suffice.
constexpr std::size_t kNewest = 3;
/// Of two radars a mean of a second is needed, since means of 0.45 s of a healthy pair reach 1.9
/// limits (0103, both rear): 1.8 limits, not with positions compared over less than 0.3 s (1.7
/// while the map begins, 0103), or one limit with positions over 0.5 s (0.96 over all, 0061).
constexpr double kLimitsOfTwo = 1.8;
constexpr double kSinceOfTwoS = 0.3;
constexpr double kLongSinceOfTwoS = 0.5;

/// The factor by which the positions of a radar in use differ from its Doppler.
std::optional<double> factor_in_use(const MotionEvidence& evidence, std::size_t radar,
                                    bool are_two) {
  constexpr std::size_t kSecond = MotionEvidence::kEpochs;
  const auto factor = are_two
                          ? evidence.scale_by_positions(radar, kSecond, kSinceOfTwoS, kLimitsOfTwo)
                          : evidence.scale_by_positions(radar, kSecond, 0.0, 1.0);
  if (factor) {
    return factor;
  }
  return are_two ? evidence.scale_by_positions(radar, kSecond, kLongSinceOfTwoS, 1.0)
                 : evidence.scale_by_positions(radar, kNewest, 0.0, 1.0);
}

/// Whether the Doppler of each radar agrees with the motion by the others: those with another fault
/// (exchanged mounts) may seem to share a scale.
bool agree(const MotionEvidence& evidence, RadarSet set) {
  const double of_all = evidence.sum_by_doppler(set).chi_square();
  return !any_of(set, [&](std::size_t radar) {
    return of_all - evidence.sum_by_doppler(set & ~set_of(radar)).chi_square() > kMaxDecrease;
  });
}

}  // namespace

void CommonScale::forget() { std::fill(doubts_.begin(), doubts_.end(), Doubt()); }

bool CommonScale::is_doubted(std::size_t radar, std::int64_t time_us) const {
  const auto& last_us = doubts_[radar].last_us;
  return last_us && seconds_between(*last_us, time_us) < kFoundByAllS;
}

std::optional<CommonScale::Finding> CommonScale::find(const MotionEvidence& evidence,
                                                      RadarSet at_fault, RadarSet accused) const {
  if (evidence.epochs() == 0) {
    return std::nullopt;
  }
  const RadarSet present = evidence.present();
  const bool are_two = std::popcount(present & ~at_fault) < 3;
  RadarSet faster = 0;
  RadarSet slower = 0;
  double sum = 0.0;
  for_each(present, [&](std::size_t i) {
    std::optional<double> factor;
    if (!contains(at_fault, i)) {
      factor = factor_in_use(evidence, i, are_two);
    } else if (is_doubted(i, evidence.time_us())) {
      factor = doubts_[i].factor;
    }
    const double share = factor.value_or(1.0) - 1.0;
    faster |= share > 0.0 ? set_of(i) : 0U;
    slower |= share < 0.0 ? set_of(i) : 0U;
    sum += share;
  });
  const RadarSet told = faster | slower;
  const RadarSet radars = told | (present & at_fault & ~accused);
  const int count = std::popcount(told);
  const double factor = 1.0 + sum / std::max(count, 1);
  const bool is_common = count > 1 && (faster == 0 || slower == 0) &&
                         (present & ~at_fault & ~told) == 0 && factor > kMinFactorOfAll &&
                         factor < 1.0 / kMinFactorOfAll && agree(evidence, radars);
  return is_common ? std::optional(Finding{factor, radars}) : std::nullopt;
}

}  // namespace cremed
