// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/self_check.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/doubt/radar/acceleration.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// A time-averaged NIS above this shows too small a covariance: errors are 1.7 times as large as
/// stated.
constexpr double kMaxMeanNis = 3.0;
/// Both means above these show it too. Noise set three times too small gives 2.1 and 1.1 or more.
/// Healthy recorded drives reach 2.3 by Doppler for seconds (nuScenes 0655 and 1094), but then 0.3
/// from motion to motion (1: the vehicle accelerates as much as its prior all the time).
constexpr double kMaxMeanByDoppler = 2.0;
constexpr double kMaxMeanByNext = 0.8;
/// A covariance is too large if both means are below these. Healthy drives have at least 0.4 and
/// 0.2: the priors of shared errors bound the first from below, and the second is small if a
/// vehicle accelerates less than its prior. Errors of half the stated size give 0.25 and 0.05.
constexpr double kMinMeanByDoppler = 0.35;
constexpr double kMinMeanByNext = 0.12;

double duration_s(const EgoMotion& motion) {
  return seconds_between(motion.utime_start_us, motion.utime_us);
}

}  // namespace

void SelfCheck::add(const EgoMotion& motion, const TargetSet& targets) {
  repeated_.add(targets);
  if (repeated_.is_repeated()) {  // No measurement.
    last_ = EgoMotion();
    return;
  }
  if (targets.is_finite() && !looks_across_) {
    speed_.add(targets, motion.utime_us);
    yaw_rate_radps_ =
        motion.has_estimate() ? motion.motion.z() / duration_s(motion) : yaw_rate_radps_;
    scale_.add(targets, yaw_rate_radps_, motion.utime_us);
  }
  if (motion.status == MotionStatus::ok) {
    if (std::isfinite(motion.doppler_nis)) {
      doppler_.add(motion.utime_us, motion.doppler_nis);
    }
    compare_with_last(motion);
  }
  last_ = motion;
}

void SelfCheck::forget() {
  last_ = EgoMotion();
  speed_.forget();
  scale_.forget();
  repeated_.forget();
}

void SelfCheck::acquit_speed() {
  speed_.forget();
  scale_.acquit();
}

void SelfCheck::begin_anew() {
  acquit_speed();
  doppler_.clear();
  next_.clear();
}

void SelfCheck::compare_with_last(const EgoMotion& motion) {
  if (last_.status != MotionStatus::ok || last_.utime_us != motion.utime_start_us) {
    return;
  }
  const double dt_s = duration_s(motion);
  const double last_dt_s = duration_s(last_);
  Eigen::Matrix3d covariance =
      motion.covariance / (dt_s * dt_s) + last_.covariance / (last_dt_s * last_dt_s);
  const SharedErrorOptions& errors = options_.shared_errors;
  covariance += acceleration_covariance(0.5 * (dt_s + last_dt_s), errors.acceleration_std_mps2,
                                        errors.yaw_acceleration_std_radps2);
  const auto weight = invert_information(covariance, options_.degrees_of_freedom);
  if (weight) {
    const Eigen::Vector3d change = motion.motion / dt_s - last_.motion / last_dt_s;
    next_.add(motion.utime_us, change.dot(*weight * change) / options_.degrees_of_freedom);
  }
}

double SelfCheck::covariance_factor() const {
  return looks_across_ ? std::max({1.0, doppler_.mean(), next_.mean()}) : 1.0;
}

std::uint32_t SelfCheck::doubts() const {
  std::uint32_t result = 0;
  if (repeated_.is_repeated()) {
    result |= positions_contradict_speed;
  }
  if (looks_across_) {
    return result;
  }
  if (doppler_.exceeds(kMaxMeanNis)) {
    result |= registration_contradicts_doppler;
  }
  if (next_.exceeds(kMaxMeanNis) ||
      (doppler_.exceeds(kMaxMeanByDoppler) && next_.exceeds(kMaxMeanByNext))) {
    result |= motions_contradict_each_other;
  }
  if (contradicts_speed()) {
    result |= positions_contradict_speed;
  }
  if (doppler_.is_enough() && doppler_.mean() < kMinMeanByDoppler && next_.is_enough() &&
      next_.mean() < kMinMeanByNext) {
    result |= covariance_too_large;
  }
  return result;
}

}  // namespace cremed
