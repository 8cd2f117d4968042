// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/measurement/radar_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Initial scan_covariance(), before the first registration: 0.1 m, 0.005 rad.
const Eigen::Vector3d kInitialScanVariance(0.1 * 0.1, 0.1 * 0.1, 0.005 * 0.005);

/// Number of targets over which residuals are averaged, five to ten scans, and the largest weight
/// of one scan.
constexpr double kLearningTargets = 500.0;
constexpr double kMaxLearningShare = 0.1;
/// Bounds of the adapted value. The grid of an ARS408 alone gives 0.25 / sqrt(12) = 0.07 m/s; above
/// 0.6 m/s Tukey's weights extend beyond 2.8 m/s and no longer reject moving targets.
constexpr double kMinDopplerStdMps = 0.05;
constexpr double kMaxDopplerStdMps = 0.6;

/// A registration that needs more steps from a prediction is unreliable: using such registrations
/// doubled the yaw error on a real drive with turns (nuScenes 0061).
constexpr int kMaxIterations = 5;
constexpr double kStepTolerance = 1e-3;  // 3 % of a standard deviation.

/// Options for positions with a predicted start: no first stage, no restarts, no Doppler, and no
/// systematic errors, for which the filter has states.
RegistrationOptions positions_only(RegistrationOptions options) {
  options.degrees_of_freedom = 3;
  options.start_scale = 1.0;
  options.max_iterations = kMaxIterations;
  options.step_tolerance = kStepTolerance;
  options.restarts = false;
  options.likelihood = Likelihood::exclusive;
  options.doppler.enabled = false;
  options.shared_errors.velocity_std_mps = 0.0;
  return options;
}

bool is_majority(const DopplerVelocity& velocity, const TargetSet& targets) {
  return 2 * static_cast<std::size_t>(velocity.targets) > targets.size();
}

}  // namespace

RadarTrack::RadarTrack(const OdometryOptions& options, const Pose2& mount,
                       const RegistrationOptions& registration)
    : options_(options), mount_(mount), registration_(positions_only(registration), mount) {
  clear();
}

void RadarTrack::clear() {
  for (Keyframe& keyframe : keyframes_) {
    keyframe.is_set = false;
  }
  has_stamp_ = false;
  doppler_std_mps_ = options_.doppler_std_mps;
  scan_covariance_ = kInitialScanVariance.asDiagonal();
}

double RadarTrack::begin(std::int64_t stamp_us) {
  const double dt_s = has_stamp_ ? seconds_between(stamp_us_, stamp_us) : 0.0;
  has_stamp_ = true;
  stamp_us_ = stamp_us;
  for (Keyframe& keyframe : keyframes_) {
    ++keyframe.lag;
  }
  return dt_s;
}

std::optional<ScanVelocity> RadarTrack::velocity(const TargetSet& targets,
                                                 const std::optional<Eigen::Vector2d>& expected) {
  auto best = expected ? doppler_.fit(targets, *expected, doppler_std_mps_) : std::nullopt;
  if (!best || !is_majority(*best, targets)) {
    const auto other =
        doppler_.fit(targets, DopplerVelocityEstimator::search(targets), doppler_std_mps_);
    best = best ? best : other;
  }
  if (!best) {
    return std::nullopt;
  }
  const double share = std::min(kMaxLearningShare, best->targets / kLearningTargets);
  const double std = std::clamp(best->residual_std_mps, kMinDopplerStdMps, kMaxDopplerStdMps);
  doppler_std_mps_ =
      std::sqrt((1.0 - share) * doppler_std_mps_ * doppler_std_mps_ + share * std * std);
  return ScanVelocity{*best, is_majority(*best, targets)};
}

bool RadarTrack::can_match(std::size_t keyframe, const TargetSet& targets) const {
  return keyframes_[keyframe].is_set && keyframes_[keyframe].lag >= options_.min_lag &&
         targets.size() >= static_cast<std::size_t>(options_.min_targets);
}

std::optional<RadarTrack::Pair> RadarTrack::match(std::size_t keyframe, const TargetSet& targets,
                                                  const Eigen::Vector3d& expected) {
  const Keyframe& from = keyframes_[keyframe];
  registration_.set_previous(from.targets);
  const RegistrationResult result = registration_.solve(targets, 1.0, {&expected, 1});
  const auto possible = static_cast<double>(std::min(targets.size(), from.targets.size()));
  if (result.status != RegistrationStatus::converged ||
      result.matched < options_.min_matched_share * possible) {
    return std::nullopt;
  }
  scan_covariance_ = result.covariance;
  return Pair{from.lag, result.motion, result.covariance};
}

std::optional<std::size_t> RadarTrack::keep(const TargetSet& targets) {
  int youngest = std::numeric_limits<int>::max();
  std::size_t oldest = 0;
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    const auto age = [](const Keyframe& keyframe) {
      return keyframe.is_set ? keyframe.lag : std::numeric_limits<int>::max();
    };
    youngest = std::min(youngest, age(keyframes_[i]));
    oldest = age(keyframes_[i]) > age(keyframes_[oldest]) ? i : oldest;
  }
  if (youngest < options_.keyframe_period ||
      targets.size() < static_cast<std::size_t>(options_.min_targets)) {
    return std::nullopt;
  }
  keyframes_[oldest].is_set = true;
  keyframes_[oldest].lag = 0;
  keyframes_[oldest].targets = targets;
  return oldest;
}

}  // namespace cremed
