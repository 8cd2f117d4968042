// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/fault_cause.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

/// Errors of a velocity by Doppler beside that of the others: noise, and a share by mounts, scale
/// and slip.
constexpr double kNoiseMps = 0.15;
constexpr double kNoiseShare = 0.02;
/// Of the sums, seven times a second: they remember ten seconds.
constexpr double kFade = 0.985;
/// A second.
constexpr double kMinCount = 7.0;
/// Of the mean of chi-square of two measurements: with the cause, and by how much it is more with
/// any other cause and with none.
constexpr double kMaxExplained = 4.0;
constexpr double kMinDifference = 4.0;
/// One motion may be missing. After a longer time lags are not those of the others.
constexpr double kMaxStepS = 0.5;
/// A larger error of the mount's yaw is a mount that was exchanged, or turned back to front.
constexpr double kMaxMountYawRad = 0.6;
constexpr double kMaxMountM = 3.0;
constexpr double kMinScale = 0.3;
constexpr double kMaxScale = 3.0;

}  // namespace

/// The two causes with the least cost.
struct FaultCauseSearch::Best {
  FaultCause cause;
  double cost = std::numeric_limits<double>::infinity();
  double next_cost = std::numeric_limits<double>::infinity();

  void add(const FaultCause& other, double other_cost) {
    if (other_cost < cost) {
      next_cost = cost;
      cost = other_cost;
      cause = other;
    } else {
      next_cost = std::min(next_cost, other_cost);
    }
  }
};

void FaultCauseSearch::Products::add(const Complex& e, const Complex& m, double weight) {
  expected += weight * std::norm(e);
  product += weight * e * std::conj(m);
}

void FaultCauseSearch::Products::fade() {
  expected *= kFade;
  product *= kFade;
}

FaultCauseSearch::FaultCauseSearch(std::span<const Pose2> mounts, std::size_t radar)
    : mounts_(mounts), radar_(radar), at_mount_(mounts.size()) {}

void FaultCauseSearch::clear() {
  count_ = 0.0;
  measured_ = 0.0;
  mirrored_ = 0.0;
  across_ = 0.0;
  turn_ = 0.0;
  std::fill(at_mount_.begin(), at_mount_.end(), Products());
  lags_.fill(Lag());
}

void FaultCauseSearch::forget() {
  clear();
  motions_ = 0;
}

FaultCauseSearch::Complex FaultCauseSearch::expected(const Eigen::Vector3d& motion,
                                                     const Pose2& mount) const {
  const double v = motion.x();
  const double w = motion.y();
  const double slip = motion.z();
  return Complex(v - w * mount.y_m, w * mount.x_m + slip * v) * std::polar(1.0, -mount.yaw_rad);
}

void FaultCauseSearch::add_motion(std::int64_t time_us, const Eigen::Vector3d& motion) {
  if (motions_ > 0) {
    const double step_s = seconds_between(past_[(motions_ - 1) % past_.size()].time_us, time_us);
    if (step_s <= 0.0 || step_s > kMaxStepS) {
      forget();
    }
  }
  motion_ = motion;
  past_[motions_++ % past_.size()] = {time_us, expected(motion, mounts_[radar_])};
}

void FaultCauseSearch::add_velocity(const Eigen::Vector2d& velocity_mps) {
  const Complex m =
      Complex(velocity_mps.x(), velocity_mps.y()) * std::polar(1.0, -mounts_[radar_].yaw_rad);
  const double weight =
      1.0 / (squared(kNoiseMps) +
             squared(kNoiseShare) * std::max(std::norm(m), motion_.x() * motion_.x()));
  const Past& now = past_[(motions_ - 1) % past_.size()];
  count_ = kFade * count_ + 1.0;
  measured_ = kFade * measured_ + weight * std::norm(m);
  mirrored_ = kFade * mirrored_ + weight * now.velocity_mps * m;
  const Complex missing = (now.velocity_mps - m) * std::polar(1.0, mounts_[radar_].yaw_rad);
  across_ = kFade * across_ + weight * motion_.y() * missing.imag();
  turn_ = kFade * turn_ + weight * squared(motion_.y());
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    at_mount_[i].fade();
    at_mount_[i].add(expected(motion_, mounts_[i]), m, weight);
  }
  for (std::size_t i = 0; i < std::min(kLags, motions_ - 1); ++i) {
    const Past& past = past_[(motions_ - 2 - i) % past_.size()];
    lags_[i] = {kFade * lags_[i].squares + weight * std::norm(past.velocity_mps - m),
                kFade * lags_[i].count + 1.0,
                kFade * lags_[i].delay_s + seconds_between(past.time_us, now.time_us)};
  }
}

double FaultCauseSearch::cost(const Products& products) const {
  return (products.expected + measured_ - 2.0 * products.product.real()) / count_;
}

/// The lag with the least cost, and by a parabola through its neighbours the delay between.
void FaultCauseSearch::try_late(Best& best) const {
  std::array<double, kLags + 1> costs{cost(at_mount_[radar_])};
  for (std::size_t i = 0; i < kLags; ++i) {
    costs[i + 1] = lags_[i].squares / lags_[i].count;
  }
  const auto least =
      static_cast<std::size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
  if (least == 0) {
    return;
  }
  const double delay_s = lags_[least - 1].delay_s / lags_[least - 1].count;
  double shift = 0.0;
  if (least < kLags) {
    const double slope = 0.5 * (costs[least + 1] - costs[least - 1]);
    const double bend = costs[least + 1] - 2.0 * costs[least] + costs[least - 1];
    shift = std::clamp(-slope / bend, -0.5, 0.5);
  }
  const double step_s = delay_s / static_cast<double>(least);
  best.add({FaultKind::late, delay_s + shift * step_s}, costs[least]);
}

std::optional<FaultCause> FaultCauseSearch::exchanged(std::uint32_t at_fault) const {
  std::size_t best = radar_;
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    if ((at_fault >> i & 1U) != 0 && cost(at_mount_[i]) < cost(at_mount_[best])) {
      best = i;
    }
  }
  const double fit = cost(at_mount_[best]);
  if (fit >= kMaxExplained || cost(at_mount_[radar_]) <= fit + kMinDifference) {
    return std::nullopt;
  }
  return FaultCause{FaultKind::exchanged, 0.0, best};
}

FaultCause FaultCauseSearch::cause(std::uint32_t at_fault) const {
  // Without all lags a late radar of an accelerating vehicle seems to have another scale.
  if (lags_.back().count < kMinCount) {
    return {};
  }
  if (const auto cause = exchanged(at_fault)) {
    return *cause;
  }
  const Products& own = at_mount_[radar_];
  const double squares = own.expected + measured_;
  Best best;
  best.add({FaultKind::unknown}, cost(own));
  best.add({FaultKind::sign, -1.0}, (squares + 2.0 * own.product.real()) / count_);
  best.add({FaultKind::upside_down}, (squares - 2.0 * mirrored_.real()) / count_);
  const double scale = own.product.real() / measured_;
  if (scale > kMinScale && scale < kMaxScale) {
    best.add({FaultKind::scale, scale}, (own.expected - scale * own.product.real()) / count_);
  }
  const double turn_rad = std::arg(own.product);
  if (std::abs(turn_rad) < kMaxMountYawRad) {
    best.add({FaultKind::mount_yaw, turn_rad}, (squares - 2.0 * std::abs(own.product)) / count_);
  }
  const double ahead_m = turn_ > 0.0 ? across_ / turn_ : 0.0;
  if (std::abs(ahead_m) < kMaxMountM) {
    best.add({FaultKind::mount_x, -ahead_m}, cost(own) - across_ * ahead_m / count_);
  }
  try_late(best);
  const bool is_clear = best.cost < kMaxExplained && best.next_cost > best.cost + kMinDifference;
  return is_clear ? best.cause : FaultCause();
}

}  // namespace cremed
