// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/radar/doppler_scale.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "cremed/estimator/doubt/radar/acceleration.hpp"
#include "cremed/estimator/doubt/radar/fixed_places.hpp"
#include "cremed/estimator/doubt/radar/side_gate.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

constexpr double kStep = 0.01;
/// Way between compared scans: a range error of 0.15 m of two targets is then 3 %.
constexpr double kWayM = 5.0;
/// Below this way the votes are too wide; above this time too few targets are found again.
constexpr double kMinWayM = 1.5;
constexpr double kMaxIntervalS = 1.0;
/// Time constant with which votes decay.
constexpr double kVotesMemoryS = 3.0;
/// Standard deviation of the difference of a target's range between two scans.
constexpr double kRangeStdM = 0.15;
constexpr double kMinWidth = 0.02;
/// Votes farther away than this have a weight below 1e-5.
constexpr double kMaxWidths = 5.0;
/// Of targets nearer to each other than this only one votes.
constexpr double kSpacingM = 0.5;
/// Healthy radars have a smaller r.
constexpr double kMaxShare = 0.03;
/// Times the curvature of the way: added to kMaxShare in turns. Positions of a healthy radar turn
/// by 1 to 4 % too little, which shifts targets beside it along the way. At curvatures of 0.06 to
/// 0.13 per m (1094) r is 0.03 on average and 0.08 at most.
constexpr double kShareByCurvatureM = 0.4;
/// Votes are clear if they exceed those of chance by this many sigmas (Poisson; a target votes in
/// five comparisons in a row).
constexpr double kClearSigmas = 4.0;
/// The sign is wrong if the votes for the way back exceed those for any r by this many sigmas.
/// With healthy radars of 0061, 0103, 1094 and RadarScenes 105 they exceed those for r = 0 by 0.7
/// at most; with the sign of Doppler flipped by 3 to 14 after a second.
constexpr double kReversedSigmas = 3.0;
/// The scale is wrong if the votes for an r above kMaxShare exceed those for 0 by this many sigmas:
/// figures at the class.
constexpr double kContradictingSigmas = 1.6;

/// Comparisons before a verdict, 0.7 s of an ARS408. Of 420 random scales of a lone radar, from the
/// start or later, 308 end as the fault matrix demands with 10, 300 with 15, 250 with none. A
/// healthy start of a lone radar takes 0.3 s longer for it.
constexpr int kTellingComparisons = 10;
/// Scans after which these are not waited for, 3 s of an ARS408: too few targets are found again.
constexpr int kMostScansAwaited = 40;

/// A target in the axes of the way between two scans.
struct AlongWay {
  double side_m;
  double steps;  // Along the way, in kStep times its length.
  double side_variance_m2;
};

}  // namespace

void DopplerScale::forget() {
  count_ = 0;
  compared_ = 0;
  awaited_ = 0;
  votes_.fill(0.0);
  reversed_.fill(0.0);
  share_by_turn_ = 0.0;
}

bool DopplerScale::is_open() const {
  return compared_ < kTellingComparisons && awaited_ < kMostScansAwaited && is_driving();
}

/// Fast enough for comparisons.
bool DopplerScale::is_driving() const { return velocity_mps_.norm() > kMinWayM / kMaxIntervalS; }

void DopplerScale::add(const TargetSet& targets, double yaw_rate_radps, std::int64_t stamp_us) {
  awaited_ += is_driving() ? 1 : 0;
  auto velocity = doppler_.fit(targets, velocity_mps_, kArs408DopplerStdMps);
  if (!velocity) {
    velocity =
        doppler_.fit(targets, DopplerVelocityEstimator::search(targets), kArs408DopplerStdMps);
  }
  if (!velocity) {
    count_ = 0;
    return;
  }
  if (jumps_.add(stamp_us, *velocity)) {
    acquit();  // Earlier votes tell nothing of Doppler after it.
  }
  advance(velocity->velocity_mps, yaw_rate_radps, stamp_us);
  Scan& now = scan(0);
  take(targets, now);
  for (std::size_t age = 1; age < count_; ++age) {
    const Scan& past = scan(age);
    const Eigen::Vector2d way_m =
        Eigen::Rotation2Dd(-past.yaw_rad) * Eigen::Vector2d(now.way_m - past.way_m);
    const bool is_last =
        age + 1 == count_ || seconds_between(scan(age + 1).stamp_us, stamp_us) > kMaxIntervalS;
    if (way_m.norm() >= kWayM || (is_last && way_m.norm() >= kMinWayM)) {
      vote(past, now, way_m);
      ++compared_;
      const double curvature = std::abs(now.yaw_rad - past.yaw_rad) / way_m.norm();
      share_by_turn_ = std::max(share_by_turn_, kShareByCurvatureM * curvature);
      judge(way_m.norm());
      return;
    }
    if (is_last) {
      return;
    }
  }
}

/// Begins the next scan: adds way and yaw since the previous one.
void DopplerScale::advance(const Eigen::Vector2d& velocity_mps, double yaw_rate_radps,
                           std::int64_t stamp_us) {
  const Scan& last = scan(0);
  const double dt_s = seconds_between(last.stamp_us, stamp_us);
  if (is_doppler_step((velocity_mps - velocity_mps_).norm(), dt_s)) {
    acquit();
  }
  const Eigen::Vector2d mean_mps = 0.5 * (velocity_mps_ + velocity_mps);
  velocity_mps_ = velocity_mps;
  newest_ = (newest_ + 1) % kScans;
  Scan& now = scan(0);
  now.stamp_us = stamp_us;
  if (count_ == 0 || !(dt_s > 0.0 && dt_s <= kMaxScanPeriodS)) {
    count_ = 1;
    now.way_m.setZero();
    now.yaw_rad = 0.0;
    return;
  }
  count_ = std::min(count_ + 1, kScans);
  const double turn_rad = yaw_rate_radps * dt_s;
  now.way_m = last.way_m + dt_s * (Eigen::Rotation2Dd(last.yaw_rad + 0.5 * turn_rad) * mean_mps);
  now.yaw_rad = last.yaw_rad + turn_rad;
  const double kept = std::exp(-dt_s / kVotesMemoryS);
  for (Votes* votes : {&votes_, &reversed_}) {
    std::for_each(votes->begin(), votes->end(), [&](double& some) { some *= kept; });
  }
  share_by_turn_ *= kept;
}

void DopplerScale::take(const TargetSet& targets, Scan& to) {
  take_fixed_places(targets, velocity_mps_, kSpacingM, fixed_);
  to.size = std::min(fixed_.size(), kMaxTargets);
  for (std::size_t i = 0; i < to.size; ++i) {
    const Target& target = fixed_[i];
    to.points[i] = {{target.x_m - mount_.x_m, target.y_m - mount_.y_m}, target.covariance_m2.yy};
  }
}

/// `way_m`: from `from` to `to`, in the axes of `from`.
void DopplerScale::vote(const Scan& from, const Scan& to, const Eigen::Vector2d& way_m) {
  const Eigen::Rotation2Dd to_from(from.yaw_rad - to.yaw_rad);
  const Eigen::Vector2d way = to_from * way_m;
  const double length_m = way.norm();
  const Eigen::Vector2d across = Eigen::Vector2d(-way.y(), way.x()) / length_m;
  const Eigen::Vector2d steps = way / (length_m * length_m * kStep);
  const auto along = [&](const Eigen::Vector2d& m, double side_variance_m2) {
    return AlongWay{across.dot(m), steps.dot(m), side_variance_m2};
  };
  std::array<AlongWay, kMaxTargets> later;
  const auto end = std::transform(
      to.points.begin(), to.points.begin() + static_cast<std::ptrdiff_t>(to.size), later.begin(),
      [&](const Point& point) { return along(point.m, point.side_variance_m2); });
  std::sort(later.begin(), end,
            [](const AlongWay& a, const AlongWay& b) { return a.side_m < b.side_m; });
  for (std::size_t i = 0; i < from.size; ++i) {
    const AlongWay before = along(to_from * from.points[i].m, from.points[i].side_variance_m2);
    const auto first = std::lower_bound(
        later.begin(), end, before.side_m - kMaxSideGateM,
        [](const AlongWay& point, double lowest_m) { return point.side_m < lowest_m; });
    for (auto now = first; now != end && now->side_m <= before.side_m + kMaxSideGateM; ++now) {
      const double share_steps = before.steps - now->steps;
      const double step = std::abs(share_steps) - 1.0 / kStep + kMiddle;
      if (step >= 0.0 && step < static_cast<double>(kSteps - 1) &&
          is_within_side_gate(before.side_m - now->side_m,
                              before.side_variance_m2 + now->side_variance_m2)) {
        Votes& votes = share_steps > 0.0 ? votes_ : reversed_;
        const auto lower = static_cast<std::size_t>(step);
        const double upper_part = step - static_cast<double>(lower);
        votes[lower] += 1.0 - upper_part;
        votes[lower + 1] += upper_part;
      }
    }
  }
}

void DopplerScale::judge(double way_m) {
  const double width_steps = std::max(kMinWidth, kRangeStdM / way_m) / kStep;
  std::array<double, kSteps> weights;  // Of votes so many steps away.
  for (std::size_t k = 0; k < kSteps; ++k) {
    weights[k] = std::exp(-0.5 * squared(static_cast<double>(k) / width_steps));
  }
  const int reach = static_cast<int>(kMaxWidths * width_steps);
  const auto near = [&](const Votes& votes, int step) {
    double sum = 0.0;
    const int last = std::min(step + reach, static_cast<int>(kSteps) - 1);
    for (int k = std::max(step - reach, 0); k <= last; ++k) {
      sum += votes[static_cast<std::size_t>(k)] *
             weights[static_cast<std::size_t>(std::abs(k - step))];
    }
    return sum;
  };
  const int by_turn = std::min(static_cast<int>(share_by_turn_ / kStep), kMaxShareSteps);
  int best = kMiddle;
  double most = 0.0;
  double healthy = 0.0;
  for (int step = kMiddle + kMinShareSteps; step <= kMiddle + kMaxShareSteps; ++step) {
    const double votes = near(votes_, step);
    best = votes > most ? step : best;
    most = std::max(votes, most);
    healthy = std::abs(step - kMiddle) <= by_turn ? std::max(votes, healthy) : healthy;
  }
  if (const double reversed = near(reversed_, kMiddle);
      reversed - most > kReversedSigmas * std::sqrt(reversed + most)) {
    correction_ = -1.0;
    is_wrong_ = true;
    return;
  }
  constexpr double kSqrtTwoPi = 2.5066;
  const double chance = std::accumulate(votes_.begin(), votes_.end(), 0.0) /
                        static_cast<double>(kSteps) * width_steps * kSqrtTwoPi;
  const bool is_at_end = best == kMiddle + kMinShareSteps || best == kMiddle + kMaxShareSteps;
  if (is_at_end || most - chance <= kClearSigmas * std::sqrt(chance + 1.0)) {
    return;  // At the end of the search the maximum lies beyond it.
  }
  const double share = kStep * (best - kMiddle);
  correction_ = 1.0 + share;
  if (std::abs(share) < kMaxShare + share_by_turn_) {
    is_wrong_ = false;
  } else if (most - healthy > kContradictingSigmas * std::sqrt(most + healthy)) {
    is_wrong_ = true;
  }
}

}  // namespace cremed
