// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/fault_cause.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Errors of a velocity by Doppler against the other radars.
struct Noise {
  struct Axis {
    double mps;
    double share;  // Of the speed.

    [[nodiscard]] double weight(double speed_mps, double more_variance) const {
      return 1.0 / (squared(mps) + squared(share * speed_mps) + more_variance);
    }
  };
  Axis along;  // The x axis of the vehicle.
  Axis across;
};
/// The noise of the targets, of this radar and the others, is added; with few targets it is most of
/// the sum. On healthy drives the sum is 0.02 to 0.05 m/s RMS along (nuScenes at 1 to 15 m/s,
/// RadarScenes 105 at 18 m/s), 0.06 to 0.11 across; in a simulated field 0.12 and 0.24.
constexpr Noise kNoise{{0.04, 0.003}, {0.08, 0.007}};
/// The same of a radar that looks sideways.
constexpr Noise kNoiseOfSide{{0.3, 0.03}, {0.3, 0.03}};
using Errors = VelocityMoments::Errors;
/// Errors of healthy radars: on these drives scales differ by up to 0.35 %, mounts by a degree.
/// An offset of theirs is in the noise.
constexpr Errors kHealthy{0.004, 0.015, 0.1, 0.001};
constexpr double kAny = 10.0;
/// Healthy, but for one error that may be of any size.
constexpr Errors with_any(double Errors::*error) {
  Errors errors = kHealthy;
  errors.*error = kAny;
  return errors;
}
/// Decay of the sums, seven times a second: they remember ten seconds.
constexpr double kFade = 0.985;
/// At rest the velocities e and m are noise, and a wrong sign can lower chi-square by chance, sigma
/// 4 |e| |m|. This many sqrt(chance_), 2.5 sigma, are subtracted from the decrease.
constexpr double kChance = 10.0;
/// Velocities in a second: with fewer no cause is named.
constexpr double kMinCount = 7.0;
/// Largest mean chi-square (of two measurements) with a cause that explains the data.
constexpr double kMaxExplained = 4.0;
/// Exchanged mounts also explain the data if this share of chi-square is left, or less: vehicles
/// that pass beside are no other fault.
constexpr double kMaxShareExchanged = 0.1;
/// All other radars are late if at most this share of chi-square is left. With two of three late by
/// 0.1 to 0.5 s it is 0.00 to 0.34 (nuScenes 0061, 0103, 1094). Without this limit two healthy
/// radars are at fault beside a scale that drifts to 1.15 (1094) or a radar that sees 15 m (0796).
constexpr double kMaxShareOfOthersLate = 0.4;
/// A cause is clear if chi-square with any other one, and with none, is larger by this: 3.5 sigma.
/// For a scale 5.5: a late radar seems to have one for seconds while the vehicle brakes (0061, 500
/// ms).
constexpr double kMinDifference = 12.0;
constexpr double kMinDifferenceOfScale = 30.0;  // And of an offset.
/// The same, 2 sigma, if the other cause is an offset: an offset is rarer than a scale, and the two
/// differ only when the speed changes.
constexpr double kMinDifferenceToOffset = 4.0;
/// Longest time between motions: one may be missing. After a longer time the lags would differ.
constexpr double kMaxStepS = 0.5;
/// A larger error of the mount's yaw is a mount that was exchanged, or turned back to front.
constexpr double kMaxMountYawRad = 0.6;
constexpr double kMaxMountM = 3.0;
/// A larger one is Doppler that is stuck.
constexpr double kMaxOffsetMps = 2.0;
/// Healthy radars have shorter ones.
constexpr double kMinDelayS = 0.05;
constexpr double kMinScale = 0.3;
constexpr double kMaxScale = 3.0;

Eigen::Matrix2d turn(double yaw_rad) { return Eigen::Rotation2Dd(yaw_rad).toRotationMatrix(); }

Eigen::Vector2d expected(const Eigen::Vector3d& motion, const Pose2& mount) {
  const double v = motion.x();
  const double w = motion.y();
  return {v - w * mount.y_m, w * mount.x_m + motion.z() * v};
}

}  // namespace

/// The two causes with the least chi-square.
struct FaultCauseSearch::Candidates {
  FaultCause best;
  double chi_square = std::numeric_limits<double>::infinity();
  double next = std::numeric_limits<double>::infinity();

  void add(const FaultCause& cause, double chi_square_of_cause) {
    if (chi_square_of_cause < chi_square) {
      next = std::exchange(chi_square, chi_square_of_cause);
      best = cause;
    } else {
      next = std::min(next, chi_square_of_cause);
    }
  }
};

FaultCauseSearch::FaultCauseSearch(std::span<const Pose2> mounts, std::size_t radar)
    : mounts_(mounts),
      radar_(radar),
      looks_across_(looks_across(mounts[radar])),
      at_mount_(mounts.size()) {}

void FaultCauseSearch::clear() {
  std::fill(at_mount_.begin(), at_mount_.end(), VelocityMoments());
  lags_.fill(Lag());
  before_ = VelocityMoments();
  leads_.fill(Lag());
  for (Past& past : past_) {
    past.own.reset();
  }
  chance_ = 0.0;
}

void FaultCauseSearch::forget() {
  clear();
  motions_ = 0;
}

void FaultCauseSearch::add_motion(std::int64_t time_us, const Eigen::Vector3d& motion,
                                  const Eigen::Matrix3d& covariance) {
  if (motions_ > 0) {
    const double step_s = seconds_between(past_[(motions_ - 1) % past_.size()].time_us, time_us);
    const bool is_step = std::abs(motion.x() - motion_.x()) > kMaxAccelerationMps2 * step_s;
    if (step_s <= 0.0 || step_s > kMaxStepS || is_step) {
      forget();  // What the others told before is not the vehicle's motion.
    }
  }
  motion_ = motion;
  motion_covariance_ = covariance;
  past_[motions_++ % past_.size()] = {time_us, expected(motion, mounts_[radar_]), std::nullopt};
}

void FaultCauseSearch::add_velocity(const Eigen::Vector2d& velocity_mps,
                                    const Eigen::Matrix2d& covariance) {
  const double speed_mps = std::max(velocity_mps.norm(), std::abs(motion_.x()));
  const Noise& noise = looks_across_ ? kNoiseOfSide : kNoise;
  Eigen::Matrix<double, 2, 3> by_motion;
  by_motion << 1.0, -mounts_[radar_].y_m, 0.0, motion_.z(), mounts_[radar_].x_m, motion_.x();
  const Eigen::Array2d own = covariance.diagonal();
  const Eigen::Array2d of_others =
      (by_motion * motion_covariance_ * by_motion.transpose()).diagonal();
  const Eigen::Array2d variance = own + of_others;
  const Eigen::Vector2d weight(noise.along.weight(speed_mps, variance.x()),
                               noise.across.weight(speed_mps, variance.y()));
  chance_ = kFade * chance_ + (own * of_others * weight.array().square()).sum();
  // A yaw rate within its noise does not tell the place of the mount: e has the same noise.
  const bool turns = squared(motion_.y()) > 9.0 * motion_covariance_(1, 1);
  const double w = turns ? motion_.y() : 0.0;
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    at_mount_[i].fade(kFade);
    at_mount_[i].add(expected(motion_, mounts_[i]), velocity_mps, w, weight);
  }
  Past& now = past(0);
  now.own = {velocity_mps, w, weight};
  for (std::size_t i = 1; i <= std::min(kLags, motions_ - 1); ++i) {
    lags_[i - 1].add(past(i).velocity_mps, *now.own, seconds_between(past(i).time_us, now.time_us));
  }
  add_leads();
}

/// All leads use the same velocity of this radar, from kLags motions ago. Otherwise long leads,
/// which miss the newest data, would seem to explain a fault that has just begun.
void FaultCauseSearch::add_leads() {
  if (motions_ <= kLags || !past(kLags).own) {
    return;
  }
  const Past& first = past(kLags);
  before_.fade(kFade);
  before_.add(first.velocity_mps, first.own->mps, first.own->yaw_rate_radps, first.own->weight);
  for (std::size_t i = 1; i <= kLags; ++i) {
    const Past& later = past(kLags - i);
    leads_[i - 1].add(later.velocity_mps, *first.own,
                      seconds_between(first.time_us, later.time_us));
  }
}

void FaultCauseSearch::Lag::add(const Eigen::Vector2d& expected_mps, const Own& own, double by_s) {
  moments.fade(kFade);
  moments.add(expected_mps, own.mps, own.yaw_rate_radps, own.weight);
  delay_s = kFade * delay_s + by_s;
}

/// As if of as many velocities as the other causes have.
double FaultCauseSearch::chi_square_if_healthy(const VelocityMoments& moments) const {
  return at_mount_[radar_].count() / moments.count() *
         moments.fit(Eigen::Matrix2d::Identity(), mounts_[radar_].yaw_rad, kHealthy).chi_square;
}

/// The delay with the least cost, by a parabola through the lag with the least and its neighbours.
void FaultCauseSearch::try_late(Candidates& candidates, const VelocityMoments& at_once,
                                const Lags& lags) const {
  std::array<double, kLags + 1> costs{chi_square_if_healthy(at_once)};
  for (std::size_t i = 0; i < kLags; ++i) {
    costs[i + 1] = chi_square_if_healthy(lags[i].moments);
  }
  const auto least = std::clamp<std::size_t>(
      static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin()), 1,
      kLags - 1);
  const double slope = 0.5 * (costs[least + 1] - costs[least - 1]);
  const double bend = costs[least + 1] - 2.0 * costs[least] + costs[least - 1];
  if (bend <= 0.0) {
    return;
  }
  const double shift = std::clamp(-slope / bend, -1.0, 1.0);
  const double delay_s = lags[least - 1].delay_s / lags[least - 1].moments.count() *
                         (1.0 + shift / static_cast<double>(least));
  if (delay_s >= kMinDelayS) {
    candidates.add({FaultKind::late, delay_s},
                   std::max(0.0, costs[least] + (slope + 0.5 * bend * shift) * shift));
  }
}

/// By Gauss-Newton.
void FaultCauseSearch::try_mount_yaw(Candidates& candidates) const {
  double yaw_rad = 0.0;
  VelocityMoments::Fit fit;
  for (int i = 0; i < 3; ++i) {
    fit = at_mount_[radar_].fit(turn(yaw_rad), mounts_[radar_].yaw_rad + yaw_rad,
                                with_any(&Errors::yaw_rad));
    yaw_rad += fit.yaw_rad;
  }
  if (std::abs(yaw_rad) < kMaxMountYawRad) {
    candidates.add({FaultKind::mount_yaw, yaw_rad}, fit.chi_square);
  }
}

// Without all lags a late radar of an accelerating vehicle seems to have another scale.
bool FaultCauseSearch::is_complete(const Lags& lags) {
  return lags.back().moments.count() >= kMinCount;
}

FaultCauseSearch::Finding FaultCauseSearch::find() const {
  if (!is_complete(lags_)) {
    return {};
  }
  const VelocityMoments& own = at_mount_[radar_];
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  const double yaw_rad = mounts_[radar_].yaw_rad;
  const Eigen::Matrix2d mirrored =
      turn(yaw_rad) * Eigen::Vector2d(1.0, -1.0).asDiagonal() * turn(-yaw_rad);
  Candidates result;
  const double healthy = own.fit(one, yaw_rad, kHealthy).chi_square;
  result.add({FaultKind::unknown}, healthy);
  result.add({FaultKind::sign, -1.0}, own.fit(-one, yaw_rad, kHealthy).chi_square);
  result.add({FaultKind::upside_down}, own.fit(mirrored, yaw_rad, kHealthy).chi_square);
  const auto scaled = own.fit(one, yaw_rad, with_any(&Errors::scale));
  if (scaled.scale > kMinScale - 1.0 && scaled.scale < kMaxScale - 1.0) {
    result.add({FaultKind::scale, 1.0 + scaled.scale}, scaled.chi_square);
  }
  const auto ahead = own.fit(one, yaw_rad, with_any(&Errors::x_m));
  if (std::abs(ahead.x_m) < kMaxMountM) {
    result.add({FaultKind::mount_x, ahead.x_m}, ahead.chi_square);
  }
  try_mount_yaw(result);
  try_late(result, own, lags_);
  const auto shifted = own.fit(one, yaw_rad, with_any(&Errors::offset_mps));
  bool is_apart = shifted.chi_square > result.chi_square + kMinDifferenceToOffset;
  if (shifted.chi_square < result.chi_square && std::abs(shifted.offset_mps) < kMaxOffsetMps) {
    result.add({FaultKind::offset, shifted.offset_mps}, shifted.chi_square);
    is_apart = true;
  }
  const bool is_scale_or_offset =
      result.best.kind == FaultKind::scale || result.best.kind == FaultKind::offset;
  const double least = is_scale_or_offset ? kMinDifferenceOfScale : kMinDifference;
  return {result.best, gain(healthy, result.chi_square),
          explains(result.chi_square) && result.next > result.chi_square + least && is_apart};
}

FaultCauseSearch::Finding FaultCauseSearch::find_others_late() const {
  if (!is_complete(leads_)) {
    return {};
  }
  Candidates early;
  try_late(early, before_, leads_);
  const double healthy = chi_square_if_healthy(before_);
  const double by_early = gain(healthy, early.chi_square);
  return {early.best, by_early,
          early.chi_square < kMaxShareOfOthersLate * healthy &&
              by_early > find().gain + kMinDifference};
}

bool FaultCauseSearch::explains(double chi_square) const {
  return chi_square < kMaxExplained * at_mount_[radar_].count();
}

/// Decrease of chi-square beyond chance.
double FaultCauseSearch::gain(double healthy, double chi_square) const {
  return explains(chi_square) ? std::max(0.0, healthy - chi_square - kChance * std::sqrt(chance_))
                              : 0.0;
}

double FaultCauseSearch::gain_at(std::size_t mount) const {
  const auto chi_square = [&](std::size_t i) {
    return at_mount_[i]
        .fit(turn(mounts_[i].yaw_rad - mounts_[radar_].yaw_rad), mounts_[i].yaw_rad, kHealthy)
        .chi_square;
  };
  const double own = chi_square(radar_);
  const double other = chi_square(mount);
  const bool explains =
      other < std::max(kMaxExplained * at_mount_[mount].count(), kMaxShareExchanged * own);
  return is_complete(lags_) && explains ? own - other : 0.0;
}

/// Unknown if it fits none of their mounts.
FaultCause FaultCauseSearch::exchanged_with(RadarSet radars) const {
  FaultCause exchanged;
  double most = kMinDifference;
  for_each(radars, [&](std::size_t other) {
    if (const double gain = gain_at(other); gain > most) {
      most = gain;
      exchanged = {FaultKind::exchanged, 0.0, other};
    }
  });
  return exchanged;
}

FaultCause FaultCauseSearch::cause(RadarSet movable) const {
  if (const FaultCause cause = exchanged_with(movable); cause.kind == FaultKind::exchanged) {
    return cause;
  }
  const Finding found = find();
  return found.is_clear ? found.cause : FaultCause();
}

}  // namespace cremed
