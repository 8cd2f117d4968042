// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/radar_track.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Number of targets over which residuals are averaged (five to ten scans), and the largest weight
/// of one scan.
constexpr double kLearningTargets = 500.0;
constexpr double kMaxLearningShare = 0.1;
/// The same where less than kShareWithoutTraffic is static: seven seconds and more. Residuals
/// of a group that moves nearly alike widen the weights, which then include more of it (1094, in a
/// turn: from 0.12 to 0.33 m/s in 0.4 s). Traffic passes, the noise of a radar stays.
constexpr double kLearningTargetsInTraffic = 10'000.0;
constexpr double kShareWithoutTraffic = 0.8;
/// Bounds of the adapted value. The grid of an ARS408 alone gives 0.25 / sqrt(12) = 0.07 m/s; above
/// 0.6 m/s Tukey's weights extend beyond 2.8 m/s and no longer reject moving targets.
constexpr double kMinAdaptedStdMps = 0.05;
constexpr double kMaxAdaptedStdMps = 0.6;

}  // namespace

RadarTrack::RadarTrack(const OdometryOptions& options) : options_(options) { clear(); }

void RadarTrack::clear() {
  stamp_us_.reset();
  doppler_std_mps_ = options_.doppler_std_mps;
  excess_.forget();
}

double RadarTrack::begin(std::int64_t stamp_us) {
  since_last_s_ = stamp_us_ ? seconds_between(*stamp_us_, stamp_us) : 0.0;
  stamp_us_ = stamp_us;
  return since_last_s_;
}

std::optional<ScanVelocity> RadarTrack::velocity(const TargetSet& targets,
                                                 const std::optional<Eigen::Vector2d>& expected) {
  auto best = expected ? doppler_.fit(targets, *expected, doppler_std_mps_) : std::nullopt;
  if (!best) {
    best = doppler_.fit(targets, DopplerVelocityEstimator::search(targets), doppler_std_mps_);
  }
  if (!best) {
    return std::nullopt;
  }
  const double static_share = best->targets / static_cast<double>(targets.size());
  const double learning_targets =
      static_share > kShareWithoutTraffic ? kLearningTargets : kLearningTargetsInTraffic;
  const double share = std::min(kMaxLearningShare, best->targets / learning_targets);
  const double std = std::clamp(best->residual_std_mps, kMinAdaptedStdMps, kMaxAdaptedStdMps);
  doppler_std_mps_ =
      std::sqrt((1.0 - share) * doppler_std_mps_ * doppler_std_mps_ + share * std * std);
  return ScanVelocity{*best, static_share > 0.5,
                      excess_.add(targets, best->velocity_mps, since_last_s_)};
}

}  // namespace cremed
