// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/parked_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cremed/estimator/scan/gate.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Time constant of the sums: six scans of an ARS408.
constexpr double kMemoryS = 0.5;
/// A radar whose last scan is older does not count.
constexpr double kRecentS = 0.5;
/// Error of a velocity at rest besides noise: offsets of all Doppler are then 0.01 to 0.03 m/s.
constexpr double kFloorXMps = 0.03;
constexpr double kFloorYMps = 0.05;
/// Limits of q / (1 - q), with errors of kShareSigmas: above the first there are two worlds; below
/// the second, and below the third for each radar alone, there is one.
constexpr double kMaxTwoWorldsShare = 0.04;
constexpr double kMaxSureShare = 0.06;
constexpr double kMaxShareOfRadar = 0.08;
constexpr double kShareSigmas = 2.0;
/// A target's noise is correlated over its scans: so many scans count as one.
constexpr double kCorrelatedScans = 2.0;
/// The noise of a creeping vehicle differs from that at rest by this share.
constexpr double kNoiseError = 0.3;
/// Learned noise of a target's Doppler: its least standard deviation, that of a driving ARS408 (at
/// rest its grid of values hides the noise); the share of a scan in it; and three steps of that
/// grid, beyond which a target moves.
constexpr double kMinDopplerStdMps = kArs408DopplerStdMps;
constexpr double kLearningShare = 0.03;
constexpr double kMovingDopplerMps = 0.75;
/// Targets within the own lane do not count: a car ahead that starts with the vehicle seems to
/// rest.
constexpr double kHalfLaneM = 1.75;
/// Turning circle of a small car, 8 m.
constexpr double kMinRadiusM = 4.0;
/// Velocities of two radars may differ by kMaxDifferenceMps and kMaxDifferenceShare besides noise:
/// a scan is up to 0.1 s older than another, and the inner radar of the tightest turn is slower. A
/// radar that rests sees less than kMaxRestingShare of the departing velocity.
constexpr double kMaxDifferenceMps = 0.1;
constexpr double kMaxDifferenceShare = 0.3;
constexpr double kMaxRestingShare = 0.5;
/// That noise in standard deviations, with which a radar surely rests, and with which it may rest.
constexpr double kRestSigmas = 2.0;
constexpr double kMayRestSigmas = 1.0;
/// A radar is outvoted by this many times as many targets.
constexpr double kMajority = 1.5;

bool starts_at_rest(const Odometry& odometry, double standstill_mps) {
  return odometry.status == OdometryStatus::initialising &&
         std::abs(odometry.twist.x()) <= standstill_mps &&
         odometry.twist_covariance(0, 0) <= squared(standstill_mps);
}

}  // namespace

void ParkedVehicle::Look::add(const TargetSet& seen, const DopplerVelocity& velocity,
                              std::int64_t now_us) {
  const double kept = std::exp(-seconds_between(stamp_us, now_us) / kMemoryS);
  stamp_us = now_us;
  for (double* sum : {&scans, &targets, &missed, &expected}) {
    *sum *= kept;
  }
  sum_mps = kept * sum_mps + velocity.velocity_mps;
  sum_variance = kept * sum_variance + velocity.covariance.diagonal();
  scans += 1.0;
  const double margin_mps = kGateSigmas * std::sqrt(noise);
  for (const Target& target : seen) {
    if (std::abs(target.y_m) < kHalfLaneM) {
      continue;
    }
    const double expected_mps =
        expected_doppler_mps(target, velocity.velocity_mps.x(), velocity.velocity_mps.y());
    const auto [low, high] = std::minmax({0.0, expected_mps});
    if (target.doppler_mps >= low - margin_mps && target.doppler_mps <= high + margin_mps) {
      targets += 1.0;
      missed += squared(target.doppler_mps - expected_mps);
      expected += squared(expected_mps);
    }
  }
}

void ParkedVehicle::Look::learn_noise(const TargetSet& seen) {
  double sum = 0.0;
  int count = 0;
  for (const Target& target : seen) {
    if (std::abs(target.doppler_mps) <= kMovingDopplerMps) {
      sum += squared(target.doppler_mps);
      ++count;
    }
  }
  const double variance = std::max(squared(kMinDopplerStdMps), count > 0 ? sum / count : 0.0);
  noise = noise == 0.0 ? variance : noise + kLearningShare * (variance - noise);
}

bool ParkedVehicle::Look::departs() const {
  const Eigen::Array2d floor(squared(kFloorXMps), squared(kFloorYMps));
  const Eigen::Array2d bound = kGateSigmas * (std_mps().square() + floor).sqrt();
  return (mean_mps().array().abs() > bound).any();
}

bool ParkedVehicle::Look::rests_beside(const Eigen::Vector2d& departing_mps, double sigmas) const {
  const Eigen::Array2d differing = (departing_mps - mean_mps()).array().abs();
  const Eigen::Array2d bound =
      kMaxDifferenceMps + sigmas * std_mps() + kMaxDifferenceShare * departing_mps.norm();
  return (differing > bound).any() && mean_mps().norm() < kMaxRestingShare * departing_mps.norm();
}

ParkedVehicle::Share ParkedVehicle::Look::share() const {
  return {missed - targets * noise, expected, targets * noise,
          2.0 * kCorrelatedScans * targets * squared(noise)};
}

void ParkedVehicle::Share::add(const Share& other) {
  rest += other.rest;
  departing += other.departing;
  noise += other.noise;
  variance += other.variance;
}

double ParkedVehicle::Share::error() const {
  return kShareSigmas * std::sqrt(variance + squared(kNoiseError * noise)) / departing;
}

void ParkedVehicle::add_output(const Odometry& odometry) {
  const bool is_standing = odometry.status == OdometryStatus::standing_still;
  const bool may_rest = is_standing || starts_at_rest(odometry, state_.options().standstill_mps);
  rest_us_ = may_rest && !may_rest_ ? odometry.utime_us : rest_us_;
  may_rest_ = may_rest;
  if (!is_parked_ && is_standing && odometry.utime_us - rest_us_ >= kParkedUs) {
    is_parked_ = true;
    verdict_ = Verdict::rests;
    std::fill(looks_.begin(), looks_.end(), Look());
  }
  if (odometry.utime_anchor_us != anchor_us_) {
    anchor_us_ = odometry.utime_anchor_us;
    parked_pose_.setZero();
  }
  if (!is_parked_) {
    parked_pose_ = odometry.pose;
    parked_odom_pose_ = odometry.odom_pose;
  }
  if (is_standing && !is_in_doubt()) {
    rest_odom_pose_ = odometry.odom_pose;
  }
}

void ParkedVehicle::widen(Odometry& odometry) const {
  if (!is_parked_) {
    return;
  }
  const Eigen::Vector3d from =
      odometry.utime_anchor_us == anchor_us_ ? parked_pose_ : Eigen::Vector3d::Zero();
  odometry.covariance.diagonal() += (odometry.pose - from).cwiseAbs2();
  const Eigen::Vector3d way = odometry.odom_pose - parked_odom_pose_;
  odometry.odom_covariance += way * way.transpose();
  odometry.motion_covariance.diagonal() += odometry.motion.cwiseAbs2();
  odometry.twist_covariance.diagonal() += odometry.twist.cwiseAbs2();
}

void ParkedVehicle::clear() {
  if (is_parked_) {
    leave();
  }
  may_rest_ = false;
}

void ParkedVehicle::leave() {
  is_parked_ = false;
  way_ += rest_odom_pose_ - parked_odom_pose_;
}

Eigen::Vector3d ParkedVehicle::take_way() { return std::exchange(way_, Eigen::Vector3d::Zero()); }

ParkedVehicle::Verdict ParkedVehicle::judge(std::size_t radar, const TargetSet& targets,
                                            const DopplerVelocity& velocity,
                                            std::int64_t stamp_us) {
  Look& look = looks_[radar];
  if (look.noise == 0.0) {
    look.learn_noise(targets);
  }
  look.add(targets, velocity, stamp_us);
  leave_out_odd(stamp_us);
  verdict_ = judge_all();
  if (verdict_ == Verdict::started) {
    leave();
  }
  if (!look.counts) {
    return Verdict::two_worlds;
  }
  if (verdict_ == Verdict::rests) {
    look.learn_noise(targets);
  }
  return verdict_;
}

/// Radars do not count that see something depart where most targets of the others rest.
void ParkedVehicle::leave_out_odd(std::int64_t stamp_us) {
  for (Look& look : looks_) {
    look.counts = look.scans > 0.0 && seconds_between(look.stamp_us, stamp_us) <= kRecentS;
  }
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const Eigen::Vector2d departing_mps = fastest_mps();
    double agree = 0.0;
    double rest = 0.0;
    for (const Look& look : looks_) {
      if (look.counts) {
        (look.rests_beside(departing_mps, kRestSigmas) ? rest : agree) += look.targets / look.scans;
      }
    }
    if (rest <= kMajority * agree) {
      return;
    }
    for (Look& look : looks_) {
      look.counts = look.counts && look.rests_beside(departing_mps, kRestSigmas);
    }
  }
}

/// The fastest mean velocity of the radars that see something depart; zero if none does.
Eigen::Vector2d ParkedVehicle::fastest_mps() const {
  Eigen::Vector2d fastest = Eigen::Vector2d::Zero();
  for (const Look& look : looks_) {
    if (look.counts && look.departs() && look.mean_mps().squaredNorm() > fastest.squaredNorm()) {
      fastest = look.mean_mps();
    }
  }
  return fastest;
}

ParkedVehicle::Verdict ParkedVehicle::judge_all() const {
  const Eigen::Vector2d departing_mps = fastest_mps();
  if (departing_mps.isZero(0.0)) {
    return Verdict::rests;
  }
  Share all;
  bool is_doubtful = false;
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const Look& look = looks_[i];
    if (!look.counts) {
      continue;
    }
    if (look.rests_beside(departing_mps, kRestSigmas) || is_sideways(i)) {
      return Verdict::two_worlds;
    }
    const Share share = look.share();
    is_doubtful = is_doubtful || share.value() > kMaxShareOfRadar ||
                  look.rests_beside(departing_mps, kMayRestSigmas);
    all.add(share);
  }
  if (all.value() - all.error() > kMaxTwoWorldsShare) {
    return Verdict::two_worlds;
  }
  return all.value() + all.error() <= kMaxSureShare && !is_doubtful ? Verdict::started
                                                                    : Verdict::undecided;
}

/// Whether the velocity is too far sideways for a vehicle that rolls on its wheels.
bool ParkedVehicle::is_sideways(std::size_t radar) const {
  const Look& look = looks_[radar];
  const Eigen::Vector2d mps = look.mean_mps();
  const double per_speed = std::abs(state_.mount(radar).x_m) / kMinRadiusM;
  const double std_mps = std::hypot(kFloorYMps, look.std_mps().y());
  return std::abs(mps.y()) > per_speed * std::abs(mps.x()) + kGateSigmas * std_mps;
}

}  // namespace cremed
