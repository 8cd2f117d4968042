// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/radar_consensus.hpp"

#include <algorithm>
#include <limits>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/doubt/vehicle/radar_set.hpp"
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

int RadarConsensus::count(std::int64_t time_us, bool agree) const {
  return static_cast<int>(std::count_if(
      trusts_.begin(), trusts_.end(),
      [&](const RadarTrust& trust) { return trust.votes(time_us) && trust.agrees == agree; }));
}

std::optional<MotionSums> RadarConsensus::contradicting_majority(std::int64_t time_us) const {
  const OdometryOptions& options = state_.options();
  MotionSums joint;
  joint.add(Eigen::Vector3d::UnitY(), 0.0, squared(options.start_yaw_rate_std_radps));
  joint.add(Eigen::Vector3d::UnitZ(), 0.0, squared(options.slip_std_rad) + state_.skid_variance());
  int radars = 0;
  bool are_all_witnesses = true;  // Witnesses may see passing vehicles on both sides.
  for (std::size_t i = 0; i < trusts_.size(); ++i) {
    const RadarTrust& trust = trusts_[i];
    if (trust.votes(time_us) && !trust.agrees) {
      const DopplerVelocity& velocity = trust.velocity;
      joint.add_velocity(
          state_.mount(i), velocity.velocity_mps,
          with_systematic_errors(velocity, options, seconds_between(trust.verdict_us, time_us)),
          velocity.covariance);
      ++radars;
      are_all_witnesses = are_all_witnesses && state_.is_witness(i);
    }
  }
  // Two measurements for each radar and two priors, less three unknowns.
  const double freedom = 2.0 * radars - 1.0;
  if (are_all_witnesses || radars < 2 || radars <= agreeing(time_us) ||
      joint.chi_square() > kMaxDisagreement * freedom) {
    return std::nullopt;
  }
  return joint;
}

bool RadarConsensus::is_lone(std::size_t radar, std::int64_t time_us) const {
  for (std::size_t i = 0; i < trusts_.size(); ++i) {
    if (i != radar && trusts_[i].votes(time_us) && !state_.is_witness(i)) {
      return false;
    }
  }
  return true;
}

bool RadarConsensus::is_step(std::int64_t time_us) const {
  std::int64_t last_agreed_us = std::numeric_limits<std::int64_t>::min();
  std::int64_t first_us = std::numeric_limits<std::int64_t>::max();
  for (const RadarTrust& trust : trusts_) {
    if (trust.votes(time_us) && trust.agrees) {
      last_agreed_us = std::max(last_agreed_us, trust.verdict_us);
    } else if (trust.votes(time_us)) {
      first_us = std::min(first_us, trust.verdict_us);
    }
  }
  return last_agreed_us < first_us;
}

bool RadarConsensus::contradicts_positions(std::int64_t time_us) const {
  int judged = 0;
  int confirmed = 0;
  for (std::size_t i = 0; i < trusts_.size(); ++i) {
    const bool is_judged =
        trusts_[i].votes(time_us) && !trusts_[i].agrees && !looks_across(state_.mount(i));
    judged += is_judged ? 1 : 0;
    confirmed += is_judged && trusts_[i].contradicts_positions ? 1 : 0;
  }
  return confirmed > 0 && 2 * confirmed >= judged;
}

double RadarConsensus::longest_contradiction_s() const {
  int scans = 0;
  for (const RadarTrust& trust : trusts_) {
    scans = trust.has_agreed() ? scans : std::max(scans, trust.contradictions);
  }
  return scans * kScanPeriodS;
}

std::uint32_t RadarConsensus::at_fault() const {
  std::uint32_t radars = 0;
  for (std::size_t i = 0; i < trusts_.size(); ++i) {
    const RadarTrust& trust = trusts_[i];
    const bool lasts = seconds_between(trust.left_out_us, trust.verdict_us) >= RadarTrust::kFaultyS;
    radars |= is_left_out(i) && lasts ? set_of(i) : 0U;
  }
  return radars;
}

}  // namespace cremed
