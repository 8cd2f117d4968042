// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/radar_trust.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

void NoiseFactor::add(double nis) {
  constexpr double kRate = 0.05;   // One over 20 measurements.
  constexpr double kMaxNis = 4.0;  // Exceeded by 2 % with a true covariance (exp(-4)).
  if (std::isnan(nis)) {
    return;
  }
  const double excess = std::min(nis, kMaxNis) - 1.0;
  value_ = std::clamp(value_ * std::exp(kRate * excess), 1.0, kMaxFactor);
}

bool RadarTrust::votes(std::int64_t time_us) const {
  return has_verdict && is_trusted && seconds_between(verdict_us, time_us) <= kScanVerdictValidS;
}

bool RadarTrust::judge(std::int64_t stamp_us, const DopplerVelocity& measured, bool is_expected) {
  has_verdict = true;
  verdict_us = stamp_us;
  velocity = measured;
  agrees = is_expected;
  contradictions = std::clamp(contradictions + (agrees ? -1 : 1), 0, kMaxContradictions);
  if (contradictions == kMaxContradictions || contradictions == 0) {
    left_out_us = is_left_out ? left_out_us : stamp_us;
    is_left_out = contradictions != 0;
  }
  const bool was_doubted = is_doubted;
  is_doubted = is_left_out && seconds_between(left_out_us, stamp_us) >= kDoubtedS;
  return is_doubted && !was_doubted;
}

void RadarTrust::forgive() {
  contradictions = 0;
  is_left_out = false;
}

}  // namespace cremed
