// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/gate/parked_vehicle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Time constant of the sums: four scans of an ARS408.
constexpr double kMemoryS = 0.3;
/// A radar whose last scan is older does not count.
constexpr double kRecentS = 0.5;
/// Bound of a velocity that counts as zero, in its standard deviations, and what they are at least:
/// the Doppler of a vehicle at rest errs by an offset of 0.01 to 0.03 m/s.
constexpr double kMaxSigmas = 3.0;
constexpr double kFloorXMps = 0.03;
constexpr double kFloorYMps = 0.05;
/// Least expected Doppler of a vote, in standard deviations of a target's, and number of votes.
constexpr double kMinVoteSigmas = 2.0;
constexpr double kMinVotes = 20.0;
/// Share of the targets at rest up to which there is one world: the vehicle ahead that starts too.
constexpr double kMaxRestShare = 0.04;
constexpr double kVoteMemoryS = 1.0;
/// Bound of that share in its standard deviations, and a factor on these: a target's noise is
/// correlated over its scans.
/// Expected Doppler, in standard deviations of a target's, of which rest is told in each scan; and
/// places at rest on average: a car ahead and one behind are one or two each.
constexpr double kSureSigmas = 6.0;
constexpr double kMaxRestPlaces = 1.0;
constexpr double kShareSigmas = 2.0;
constexpr double kCorrelation = 1.5;
/// Standard deviation of a target's Doppler, before it is learned and at least: the grid of an
/// ARS408, 0.25 / sqrt(12); the share of a scan in it; and three steps of that grid, beyond which a
/// target moves.
constexpr double kMinDopplerStdMps = 0.07;
constexpr double kLearningShare = 0.05;
constexpr double kMaxNoiseMps = 0.75;
/// Turning circle of a small car, 8 m.
constexpr double kMinRadiusM = 4.0;
/// Radars differ in speed by this and this share, besides noise: a scan is up to 0.1 s older than
/// another.
constexpr double kSpeedSigmas = 2.0;
constexpr double kMaxDifferenceMps = 0.1;
constexpr double kMaxDifferenceShare = 0.15;
/// Beyond this sigma a radar does not tell the speed along x.
constexpr double kMaxStdMps = 0.15;

/// Places of targets, as far as they matter. See RivalSpeed for the radius.
struct RestPlaces {
  std::array<const Target*, 6> first{};
  std::size_t count = 0;

  void add(const Target& target) {
    constexpr double kPlaceRadiusM = 3.0;
    const bool is_known =
        std::any_of(first.begin(), first.begin() + count, [&](const Target* other) {
          return std::hypot(target.x_m - other->x_m, target.y_m - other->y_m) < kPlaceRadiusM;
        });
    if (!is_known && count < first.size()) {
      first[count++] = &target;
    }
  }
};

double variance_at_rest(const TargetSet& targets) {
  double sum = 0.0;
  int count = 0;
  for (const Target& target : targets) {
    if (std::abs(target.doppler_mps) <= kMaxNoiseMps) {
      sum += squared(target.doppler_mps);
      ++count;
    }
  }
  return std::max(squared(kMinDopplerStdMps), count > 0 ? sum / count : 0.0);
}

}  // namespace

void ParkedVehicle::Look::decay(double dt_s) {
  double factor = std::exp(-dt_s / kMemoryS);
  scans *= factor;
  targets *= factor;
  sum_mps *= factor;
  sum_variance *= factor;
  sure_votes *= factor;
  rest_places *= factor;
  factor = std::exp(-dt_s / kVoteMemoryS);
  votes *= factor;
  expected *= factor;
  missed *= factor;
  noise *= factor;
}

void ParkedVehicle::Look::add(const Look& other) {
  votes += other.votes;
  expected += other.expected;
  missed += other.missed;
  noise += other.noise;
}

void ParkedVehicle::Look::add(const TargetSet& seen, const DopplerVelocity& velocity,
                              double doppler_variance) {
  RestPlaces places;
  scans += 1.0;
  targets += static_cast<double>(seen.size());
  sum_mps += velocity.velocity_mps;
  sum_variance += velocity.covariance.diagonal();
  for (const Target& target : seen) {
    const double expected_mps = -target.cos_bearing * velocity.velocity_mps.x() -
                                target.sin_bearing * velocity.velocity_mps.y();
    if (squared(expected_mps) < squared(kMinVoteSigmas) * doppler_variance) {
      continue;
    }
    const double sign = expected_mps < 0.0 ? -1.0 : 1.0;
    const double noise_mps = kMaxSigmas * std::sqrt(doppler_variance);
    const double along_mps = sign * target.doppler_mps;
    if (along_mps < -noise_mps || along_mps > std::abs(expected_mps) + noise_mps) {
      continue;
    }
    const bool is_sure = std::abs(expected_mps) >= kSureSigmas * std::sqrt(doppler_variance);
    sure_votes += is_sure ? 1.0 : 0.0;
    if (is_sure && std::abs(target.doppler_mps) <= kMaxSigmas * std::sqrt(doppler_variance)) {
      places.add(target);
    }
    votes += 1.0;
    expected += squared(expected_mps);
    missed += std::min(squared(target.doppler_mps - expected_mps), squared(expected_mps));
    noise += doppler_variance;
  }
  rest_places += static_cast<double>(places.count);
}

/// Only vehicles that start too are at rest, ahead and behind: a few places.
bool ParkedVehicle::Look::has_few_rest_places() const {
  return sure_votes >= kMinVotes && rest_places <= kMaxRestPlaces * scans;
}

bool ParkedVehicle::Look::departs() const {
  const Eigen::Array2d floor(squared(kFloorXMps), squared(kFloorYMps));
  return (mean_mps().array().square() > squared(kMaxSigmas) * (variance().array() + floor)).any();
}

bool ParkedVehicle::Look::has_votes() const { return votes >= kMinVotes; }

double ParkedVehicle::Look::rest_share(double sigmas) const {
  return (missed - noise + sigmas * kCorrelation * noise * std::sqrt(2.0 / votes)) / expected;
}

ParkedVehicle::ParkedVehicle(const OdometryState& state)
    : state_(state),
      looks_(state.radars()),
      doppler_variances_(state.radars(), squared(kMinDopplerStdMps)) {}

void ParkedVehicle::clear() { is_parked_ = is_standing_ = false; }

void ParkedVehicle::add_status(std::int64_t utime_us, bool is_standing) {
  if (is_standing && !is_standing_) {
    standing_us_ = utime_us;
  }
  is_standing_ = is_standing;
  if (!is_parked_ && is_standing && utime_us - standing_us_ >= kParkedUs) {
    is_parked_ = true;
    std::fill(looks_.begin(), looks_.end(), Look());
  }
}

ParkedVehicle::Verdict ParkedVehicle::judge(std::size_t radar, const TargetSet& targets,
                                            const DopplerVelocity& velocity,
                                            std::int64_t stamp_us) {
  Look& look = looks_[radar];
  look.decay(seconds_between(look.stamp_us, stamp_us));
  look.stamp_us = stamp_us;
  double& doppler_variance = doppler_variances_[radar];
  look.add(targets, velocity, doppler_variance);
  const Verdict result = verdict(stamp_us);
  if (result == Verdict::rests) {
    doppler_variance += kLearningShare * (variance_at_rest(targets) - doppler_variance);
  }
  if (result == Verdict::started) {
    clear();
  }
  return result;
}

ParkedVehicle::Verdict ParkedVehicle::verdict(std::int64_t stamp_us) const {
  bool departs = false;
  bool is_doubtful = false;
  double lowest_mps = std::numeric_limits<double>::infinity();
  double highest_mps = -lowest_mps;
  bool has_start = false;
  double rest_places = 0.0;
  Look all;
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const Look& look = looks_[i];
    if (!(look.scans > 0.0 && seconds_between(look.stamp_us, stamp_us) <= kRecentS)) {
      continue;
    }
    departs = departs || look.departs();
    if (look.has_few_rest_places()) {
      has_start = true;
      rest_places += look.rest_places / look.scans;
      is_doubtful = is_doubtful || !is_along(i);
    } else if (look.has_votes()) {
      is_doubtful = is_doubtful || look.rest_share(-kShareSigmas) > kMaxRestShare || !is_along(i);
      all.add(look);
    } else {
      is_doubtful = is_doubtful || (look.targets >= kMinVotes && !looks_across(state_.mount(i)));
    }
    const double std_mps = std::sqrt(look.variance().x());
    if (std_mps <= kMaxStdMps) {
      is_doubtful = is_doubtful || !look.departs();
      lowest_mps = std::min(lowest_mps, look.mean_mps().x() + kSpeedSigmas * std_mps);
      highest_mps = std::max(highest_mps, look.mean_mps().x() - kSpeedSigmas * std_mps);
    }
  }
  if (!departs) {
    return Verdict::rests;
  }
  const double speed_mps = std::max(std::abs(lowest_mps), std::abs(highest_mps));
  const bool agree =
      highest_mps - lowest_mps <= kMaxDifferenceMps + kMaxDifferenceShare * speed_mps;
  const bool is_one_world =
      all.has_votes() ? all.rest_share(kShareSigmas) <= kMaxRestShare : has_start;
  return agree && is_one_world && rest_places <= kMaxRestPlaces && !is_doubtful ? Verdict::started
                                                                                : Verdict::in_doubt;
}

/// Whether the velocity is one of a vehicle that cannot move sideways.
bool ParkedVehicle::is_along(std::size_t radar) const {
  const Look& look = looks_[radar];
  const Eigen::Vector2d mps = look.mean_mps();
  const double per_speed = std::abs(state_.mount(radar).x_m) / kMinRadiusM;
  const double std_mps = kFloorYMps + std::sqrt(look.variance().y());
  return std::abs(mps.y()) <= per_speed * std::abs(mps.x()) + kMaxSigmas * std_mps;
}

}  // namespace cremed
