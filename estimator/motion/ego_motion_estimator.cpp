// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/motion/ego_motion_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/median.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {

std::string_view to_string(MotionStatus status) {
  static constexpr std::array<std::string_view, kMotionStatusCount> kNames{
      "ok",           "standing_still",  "no_reference", "incomplete_scan",
      "gap_too_long", "too_few_targets", "degenerate",   "no_convergence",
      "non_finite",   "implausible",     "ambiguous"};
  return kNames[static_cast<std::size_t>(status)];
}

EgoMotionEstimator::EgoMotionEstimator(const EgoMotionOptions& options)
    : options_(options),
      registration_(options.registration, options.vehicle_from_radar),
      two_worlds_(options.vehicle_from_radar) {}

EgoMotion EgoMotionEstimator::begin(const RadarScan& scan) const {
  EgoMotion motion;
  motion.utime_us = scan.stamp_us;
  motion.utime_start_us = has_reference_ ? reference_stamp_us_ : scan.stamp_us;
  motion.incomplete = scan.status != ScanStatus::complete;
  return motion;
}

EgoMotion EgoMotionEstimator::reject(const RadarScan& scan) {
  EgoMotion motion = begin(scan);
  motion.status = MotionStatus::incomplete_scan;
  targets_.clear();
  return motion;
}

EgoMotion EgoMotionEstimator::update(const RadarScan& scan) {
  EgoMotion motion = begin(scan);
  // 1. The usable targets, corrected.
  motion.status = select_targets(scan);
  motion.targets = static_cast<int>(targets_.size());
  if (motion.status != MotionStatus::ok) {
    return motion;
  }
  // 2. Their motion since the scan before (1-8), and whether that is credible.
  const double dt_s = seconds_between(reference_stamp_us_, scan.stamp_us);
  if (!has_reference_) {
    motion.status = MotionStatus::no_reference;
  } else if (!(dt_s > 0.0 && dt_s <= options_.max_gap_s)) {
    motion.status = MotionStatus::gap_too_long;
    last_velocity_.setZero();
    has_velocity_ = has_started_ = false;
  } else {
    motion.status = solve(dt_s, motion);
  }
  // 3. The scan is the reference of the next.
  registration_.set_previous(targets_);
  reference_stamp_us_ = scan.stamp_us;
  has_reference_ = true;
  return motion;
}

void EgoMotionEstimator::forget_reference() {
  has_reference_ = has_velocity_ = has_started_ = false;
}

void EgoMotionEstimator::correct_doppler(double factor) {
  options_.correction.doppler_scale *= factor;
  targets_.scale_doppler(factor);
  forget_reference();
}

/// ok if the scan is usable.
MotionStatus EgoMotionEstimator::select_targets(const RadarScan& scan) {
  targets_.clear();
  if (scan.status == ScanStatus::conflicting_parts || scan.status == ScanStatus::over_capacity) {
    return MotionStatus::incomplete_scan;
  }
  targets_.assign(scan, options_.vehicle_from_radar, options_.limits, selection_,
                  options_.correction);
  if (!targets_.is_finite()) {
    return MotionStatus::non_finite;
  }
  // A mixture needs at least one component.
  const int needed = std::max(options_.min_targets, 1);
  return static_cast<int>(targets_.size()) < needed ? MotionStatus::too_few_targets
                                                    : MotionStatus::ok;
}

MotionStatus EgoMotionEstimator::solve(double dt_s, EgoMotion& motion) {
  const double doppler_mps = doppler_speed_mps();
  const std::array<Eigen::Vector3d, 3> starts{
      Eigen::Vector3d::Zero(), last_velocity_ * dt_s, {doppler_mps * dt_s, 0.0, 0.0}};
  const auto predicted = predict(doppler_mps, dt_s);
  const RegistrationResult result = registration_.solve(targets_, dt_s, starts, predicted);
  motion.iterations = result.iterations;
  const MotionStatus status = judge(result, dt_s);
  has_velocity_ = status == MotionStatus::ok || status == MotionStatus::standing_still;
  if (has_velocity_) {
    has_started_ = true;
    motion.motion = result.motion;
    motion.covariance = result.covariance;
    motion.doppler_nis = result.doppler_nis;
    motion.by_positions = result.by_positions;
    last_velocity_ = result.motion / dt_s;
  }
  return status;
}

/// None if Doppler shows another speed than a vehicle can reach from the last motion.
std::optional<PredictedMotion> EgoMotionEstimator::predict(double doppler_mps, double dt_s) const {
  if (!has_velocity_ || std::abs(doppler_mps - last_velocity_.x()) > kMaxAccelerationMps2 * dt_s) {
    return std::nullopt;
  }
  const Eigen::Vector3d velocity(doppler_mps, last_velocity_.y(), last_velocity_.z());
  return PredictedMotion{velocity * dt_s, continued(dt_s)};
}

MotionStatus EgoMotionEstimator::judge(const RegistrationResult& result, double dt_s) {
  switch (result.status) {
    case RegistrationStatus::converged:
      break;
    case RegistrationStatus::degenerate:
      return MotionStatus::degenerate;
    case RegistrationStatus::ambiguous:
      if (!continues(result, dt_s)) {
        return MotionStatus::ambiguous;
      }
      break;
    case RegistrationStatus::no_convergence:
      return MotionStatus::no_convergence;
    case RegistrationStatus::non_finite:
      return MotionStatus::non_finite;
  }
  if (!result.motion.allFinite() || !result.covariance.allFinite()) {
    return MotionStatus::non_finite;
  }
  const Eigen::Vector3d sigma = result.covariance.diagonal().cwiseSqrt();
  if (sigma.head<2>().maxCoeff() > options_.max_std_m || sigma.z() > options_.max_std_rad) {
    return MotionStatus::degenerate;
  }
  if (!options_.allows(result.motion, dt_s)) {
    return MotionStatus::implausible;
  }
  if (sees_two_worlds(result, dt_s)) {
    return MotionStatus::ambiguous;
  }
  return is_standing(result, dt_s) ? MotionStatus::standing_still : MotionStatus::ok;
}

ContinuedMotion EgoMotionEstimator::continued(double dt_s) const {
  const Eigen::Vector3d limits(kMaxAccelerationMps2, kMaxAccelerationMps2,
                               kMaxYawAccelerationRadps2);
  return {last_velocity_ * dt_s, limits * dt_s * dt_s};
}

bool EgoMotionEstimator::continues(const RegistrationResult& result, double dt_s) const {
  return has_velocity_ && continued(dt_s).allows(result);
}

/// Uses Doppler even if the estimate does not.
bool EgoMotionEstimator::sees_two_worlds(const RegistrationResult& result, double dt_s) {
  const double noise_mps = std::sqrt(result.covariance(0, 0)) / dt_s;
  RegistrationResult other = result;
  return two_worlds_.check(
      targets_, result.motion / dt_s, 0.5 * kMaxAccelerationMps2 * dt_s + kGateSigmas * noise_mps,
      has_started_ ? TwoWorlds::Before::motion : TwoWorlds::Before::first_scans,
      [&](double speed_mps) {
        other.motion.x() = speed_mps * dt_s;
        return continues(other, dt_s);
      });
}

/// Doppler alone is not sufficient: a radar that looks sideways, or is in the centre of a turn,
/// measures none while the vehicle moves. A small estimate alone is not sufficient if its sigma is
/// large.
bool EgoMotionEstimator::is_standing(const RegistrationResult& result, double dt_s) {
  const double limit_m = options_.standstill_mps * dt_s;
  const Eigen::Vector3d sigma = result.covariance.diagonal().cwiseSqrt();
  return result.motion.head<2>().norm() <= limit_m && sigma.head<2>().maxCoeff() <= limit_m &&
         std::abs(result.motion.z()) <= kGateSigmas * sigma.z() &&
         median_normalised_doppler() <= 1.0;
}

/// 0.67 for Gaussian noise. A value up to 1 counts as noise, which allows a standard deviation 1.5
/// times as large as stated.
double EgoMotionEstimator::median_normalised_doppler() {
  const auto last =
      std::transform(targets_.begin(), targets_.end(), scratch_.begin(),
                     [](const Target& t) { return std::abs(t.doppler_mps) / t.doppler_std_mps; });
  return median_or(0.0, scratch_.begin(), last);
}

/// Median speed along x by the Doppler of all targets, if they are static and the yaw rate is
/// unchanged. Targets abeam do not observe it.
double EgoMotionEstimator::doppler_speed_mps() {
  const Eigen::Vector3d turning(0.0, 0.0, has_velocity_ ? last_velocity_.z() : 0.0);
  auto last = scratch_.begin();
  for (const Target& target : targets_) {
    if (std::abs(target.cos_bearing) > kMinForwardCosine) {
      *last++ = speed_along_x_mps(target, turning, options_.vehicle_from_radar);
    }
  }
  return median_or(0.0, scratch_.begin(), last);
}

}  // namespace cremed
