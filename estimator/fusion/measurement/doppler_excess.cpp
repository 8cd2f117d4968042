// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/doppler_excess.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

/// Residuals beyond are of traffic that the fit rejects: Tukey's limit with an ARS408's noise.
constexpr double kNearMps = 0.6;
/// Time constants: of the mean, some scans; of the noise, which falls to the mean as soon as
/// traffic is gone, and rises slowly: after a minute of an unbroken jam the cars count as noise.
constexpr double kExcessMeanS = 0.5;
constexpr double kNoiseFallS = 2.0;
constexpr double kNoiseRiseS = 60.0;
/// Two numbers of the velocity are fitted to them.
constexpr int kMinNearTargets = 10;
constexpr int kFittedNumbers = 2;
/// The mean of 30 targets over 0.5 s is right to a tenth; the noise is the lower edge of that.
constexpr double kNoiseMargin = 1.5;
/// Scans whose mean is the first noise: a second.
constexpr int kFirstScans = 15;

std::optional<double> mean_square(const TargetSet& targets, const Eigen::Vector2d& velocity_mps) {
  double sum = 0.0;
  int count = 0;
  for (const Target& target : targets) {
    const double residual_mps =
        target.doppler_mps - expected_doppler_mps(target, velocity_mps.x(), velocity_mps.y());
    if (std::abs(residual_mps) < kNearMps) {
      sum += squared(residual_mps);
      ++count;
    }
  }
  return count >= kMinNearTargets ? std::optional(sum / (count - kFittedNumbers)) : std::nullopt;
}

}  // namespace

double DopplerExcess::add(const TargetSet& targets, const Eigen::Vector2d& velocity_mps,
                          double dt_s) {
  const auto of_scan = mean_square(targets, velocity_mps);
  if (!of_scan) {
    return 0.0;
  }
  scans_ = std::min(scans_ + 1, kFirstScans);
  const double first = scans_ < kFirstScans ? 1.0 / scans_ : 0.0;
  mean_m2ps2_ += std::max(first, 1.0 - std::exp(-dt_s / kExcessMeanS)) * (*of_scan - mean_m2ps2_);
  const double time_s = mean_m2ps2_ < noise_m2ps2_ ? kNoiseFallS : kNoiseRiseS;
  noise_m2ps2_ += std::max(first, 1.0 - std::exp(-dt_s / time_s)) * (mean_m2ps2_ - noise_m2ps2_);
  const double noise_m2ps2 = std::max(squared(kArs408DopplerStdMps), kNoiseMargin * noise_m2ps2_);
  return std::max(0.0, mean_m2ps2_ - noise_m2ps2);
}

}  // namespace cremed
