// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/radar_consensus.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Scan period of a slow radar: bounds the duration of a contradiction.
constexpr double kScanPeriodS = 0.1;
/// Bound of chi-square per degree of freedom of radars that agree on a velocity. False-alarm rate
/// with two radars: 1 in 135 (chi-square of three degrees of freedom above 12); lower with more.
constexpr double kMaxDisagreement = 4.0;

/// Covariance of a velocity that is `age_s` old: with systematic errors of the radar, and the
/// vehicle's acceleration since.
Eigen::Matrix2d with_systematic_errors(const DopplerVelocity& velocity,
                                       const OdometryOptions& options, double age_s) {
  const double changed = squared(SharedErrorOptions().acceleration_std_mps2 * age_s);
  Eigen::Matrix2d noise = velocity.covariance;
  noise(0, 0) += squared(options.doppler_x.std) + squared(options.offset.std) + changed;
  noise(1, 1) += squared(options.doppler_y.std) + changed +
                 squared(options.mount_yaw_std_rad * velocity.velocity_mps.norm());
  return noise;
}

}  // namespace

RadarConsensus::RadarConsensus(const OdometryState& state)
    : state_(state), trusts_(state.radars()) {}

void RadarConsensus::clear() { std::fill(trusts_.begin(), trusts_.end(), RadarTrust()); }

RadarSet RadarConsensus::voting(std::int64_t time_us, bool agree) const {
  return filter(first_radars(trusts_.size()), [&](std::size_t i) {
    return trusts_[i].votes(time_us) && trusts_[i].agrees == agree;
  });
}

std::optional<MotionSums> RadarConsensus::contradicting_majority(std::int64_t time_us) const {
  const RadarSet radars = contradicting(time_us);
  const int count = std::popcount(radars);
  // Witnesses may see passing vehicles on both sides.
  const bool are_all_witnesses = (radars & ~state_.witnesses()) == 0;
  if (are_all_witnesses || count < 2 || count <= std::popcount(agreeing(time_us))) {
    return std::nullopt;
  }
  const OdometryOptions& options = state_.options();
  MotionSums joint;
  joint.add(Eigen::Vector3d::UnitY(), 0.0, squared(options.start_yaw_rate_std_radps));
  joint.add(Eigen::Vector3d::UnitZ(), 0.0, squared(options.slip_std_rad) + state_.skid_variance());
  for_each(radars, [&](std::size_t i) {
    const DopplerVelocity& velocity = trusts_[i].velocity;
    const double age_s = seconds_between(trusts_[i].verdict_us, time_us);
    joint.add_velocity(state_.mount(i), velocity.velocity_mps,
                       with_systematic_errors(velocity, options, age_s), velocity.covariance);
  });
  // Two measurements for each radar and two priors, less three unknowns.
  const double freedom = 2.0 * count - 1.0;
  return joint.chi_square() > kMaxDisagreement * freedom ? std::nullopt : std::optional(joint);
}

bool RadarConsensus::is_step(std::int64_t time_us) const {
  std::int64_t last_agreed_us = std::numeric_limits<std::int64_t>::min();
  std::int64_t first_us = std::numeric_limits<std::int64_t>::max();
  for_each(agreeing(time_us), [&](std::size_t i) {
    last_agreed_us = std::max(last_agreed_us, trusts_[i].verdict_us);
  });
  for_each(contradicting(time_us),
           [&](std::size_t i) { first_us = std::min(first_us, trusts_[i].verdict_us); });
  return last_agreed_us < first_us;
}

bool RadarConsensus::contradicts_positions(std::int64_t time_us) const {
  const RadarSet judged = contradicting(time_us) & state_.ahead();
  const RadarSet confirmed =
      filter(judged, [&](std::size_t i) { return trusts_[i].contradicts_positions; });
  return confirmed != 0 && 2 * std::popcount(confirmed) >= std::popcount(judged);
}

double RadarConsensus::longest_contradiction_s() const {
  int scans = 0;
  for (const RadarTrust& trust : trusts_) {
    scans = trust.has_agreed() ? scans : std::max(scans, trust.contradictions);
  }
  return scans * kScanPeriodS;
}

RadarSet RadarConsensus::at_fault() const {
  return filter(first_radars(trusts_.size()) & ~state_.ahead(), [&](std::size_t i) {
    const RadarTrust& trust = trusts_[i];
    return trust.is_left_out &&
           seconds_between(trust.left_out_us, trust.verdict_us) >= RadarTrust::kFaultyS;
  });
}

}  // namespace cremed
