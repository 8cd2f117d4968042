// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/gate/parked_vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio> //DBG
#include <cstdlib> //DBG

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
/// Least expected Doppler of a vote, four standard deviations of a target's, and number of votes.
constexpr double kMinVoteMps = 0.5;
constexpr double kMinVotes = 20.0;
/// Share of the targets at rest up to which there is one world.
constexpr double kMaxRestShare = 0.1;
/// Turning circle of a small car, 8 m.
constexpr double kMinRadiusM = 4.0;
/// Radars differ in speed by this and this share: a scan is up to 0.1 s older than another.
constexpr double kMaxDifferenceMps = 0.2;
constexpr double kMaxDifferenceShare = 0.1;
/// Beyond this sigma a radar does not tell the speed along x.
constexpr double kMaxStdMps = 0.15;

}  // namespace

void ParkedVehicle::Look::decay(double factor) {
  scans *= factor;
  sum_mps *= factor;
  sum_variance *= factor;
  votes *= factor;
  at_rest *= factor;
}

void ParkedVehicle::Look::add(const TargetSet& targets, const DopplerVelocity& velocity) {
  scans += 1.0;
  sum_mps += velocity.velocity_mps;
  sum_variance += velocity.covariance.diagonal();
  for (const Target& target : targets) {
    const double expected_mps = -target.cos_bearing * velocity.velocity_mps.x() -
                                target.sin_bearing * velocity.velocity_mps.y();
    if (std::abs(expected_mps) < kMinVoteMps) {
      continue;
    }
    votes += 1.0;
    at_rest += std::abs(target.doppler_mps) < 0.5 * std::abs(expected_mps) ? 1.0 : 0.0;
  }
}

bool ParkedVehicle::Look::departs() const {
  const Eigen::Array2d floor(squared(kFloorXMps), squared(kFloorYMps));
  return (mean_mps().array().square() > squared(kMaxSigmas) * (variance().array() + floor)).any();
}

bool ParkedVehicle::Look::has_votes() const { return votes >= kMinVotes; }

bool ParkedVehicle::Look::is_one_world() const {
  return at_rest + std::sqrt(at_rest) <= kMaxRestShare * votes;
}

ParkedVehicle::ParkedVehicle(const OdometryState& state) : state_(state), looks_(state.radars()) {}

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
  look.decay(std::exp(-seconds_between(look.stamp_us, stamp_us) / kMemoryS));
  look.stamp_us = stamp_us;
  look.add(targets, velocity);
  const Verdict result = verdict(stamp_us);
  if (std::getenv("P21")) std::fprintf(stderr, "   r%zu V %.3f %.3f mean %.3f %.3f std %.3f %.3f votes %.1f rest %.1f  dep%d one%d -> %d\n", radar, velocity.velocity_mps.x(), velocity.velocity_mps.y(), look.mean_mps().x(), look.mean_mps().y(), std::sqrt(look.variance().x()), std::sqrt(look.variance().y()), look.votes, look.at_rest, look.departs(), can_be_start(radar), int(result)); //DBG
  if (result == Verdict::started) {
    clear();
  }
  return result;
}

ParkedVehicle::Verdict ParkedVehicle::verdict(std::int64_t stamp_us) const {
  const auto is_recent = [&](const Look& look) {
    return look.scans > 0.0 && seconds_between(look.stamp_us, stamp_us) <= kRecentS;
  };
  bool departs = false;
  bool is_refuted = false;
  double slowest_mps = 0.0;
  double fastest_mps = 0.0;
  int speeds = 0;
  bool has_start = false;
  for (std::size_t i = 0; i < looks_.size(); ++i) {
    const Look& look = looks_[i];
    if (!is_recent(look)) {
      continue;
    }
    departs = departs || look.departs();
    const bool is_start = look.has_votes() && can_be_start(i);
    has_start = has_start || is_start;
    is_refuted = is_refuted || (look.has_votes() && !is_start);
    if (std::sqrt(look.variance().x()) <= kMaxStdMps) {
      const double mps = look.mean_mps().x();
      slowest_mps = speeds == 0 ? mps : std::min(slowest_mps, mps);
      fastest_mps = speeds == 0 ? mps : std::max(fastest_mps, mps);
      ++speeds;
    }
  }
  if (!departs) {
    return Verdict::rests;
  }
  const double speed_mps = std::max(std::abs(slowest_mps), std::abs(fastest_mps));
  const bool agree =
      has_start &&
      fastest_mps - slowest_mps <= kMaxDifferenceMps + kMaxDifferenceShare * speed_mps;
  return agree && !is_refuted ? Verdict::started : Verdict::in_doubt;
}

bool ParkedVehicle::can_be_start(std::size_t radar) const {
  const Look& look = looks_[radar];
  const Eigen::Vector2d mps = look.mean_mps();
  const double lever_m = std::abs(state_.mount(radar).x_m);
  return look.is_one_world() &&
         std::abs(mps.y()) <= lever_m / kMinRadiusM * std::abs(mps.x()) +
                                  kMaxSigmas * (kFloorYMps + std::sqrt(look.variance().y()));
}

}  // namespace cremed
