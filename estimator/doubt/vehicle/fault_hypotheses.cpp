// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/fault_hypotheses.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

constexpr double kEpochS = 0.15;
/// Two missing scans. Between scans further apart the velocity is not interpolated.
constexpr double kMaxScanPeriodS = 0.3;
/// Largest decrease of chi-square by leaving out a radar, of 2 to 4 measurements. Healthy drives
/// have 4.6 at most (nuScenes 0061, 0103, 0655, 0796, 1094, RadarScenes 105); a Doppler scale of
/// 0.95 has 18 to 84, a mount 5 degrees off 22 to 35, a mirrored front radar 26 to 600 in turns.
constexpr double kMaxDecrease = 8.0;
/// The same for a radar that is at fault already.
constexpr double kMaxDecreaseToReturn = 4.0;
/// Largest part of chi-square by a radar that looks sideways; see the class.
constexpr double kMaxWitness = 9.0;
/// Bound of the noise of a velocity's change. Larger steps are not interpolated.
constexpr double kMaxNoiseMps = 0.75;
/// Largest standard deviation of a speed by positions that confirms the Doppler. With it 10 % are 3
/// sigma.
constexpr double kSupportingStdMps = 0.1;
constexpr double kSupportingShare = 0.02;
/// Age of the speed by positions: of the same scan or the one before.
constexpr double kMaxPositionsAgeS = 0.1;
/// Change of the velocity between two scans other than linear.
constexpr double kBetweenScansMps = 0.05;
/// Errors by positions: of the way, 1.1 % over 2 s on these drives, and that of one scan; of the
/// yaw rate, 0.1 to 0.35 degrees a second, and turns registered 1 to 4 % too small.
constexpr double kPositionSpeedShare = 0.01;
constexpr double kPositionM = 0.05;
/// Of the state's speed, which they correct.
constexpr double kPositionMps = 0.05;
constexpr double kPositionYawRateRadps = 0.008;
constexpr double kPositionTurnShare = 0.03;
/// In addition to OdometryOptions: a mount measured by hand that is a degree off is learned.
constexpr double kMoreMountYawStdRad = 0.005;
/// Speed along x of a radar that looks sideways: that of the reflections of passed objects.
constexpr double kWitnessMps = 0.5;
constexpr double kWitnessShare = 0.3;
/// Bound of the difference of two speeds. False-alarm rate: 1 in 16000.
constexpr double kMaxSpeedSigmas = 4.0;
/// Scale of Doppler that the filter learns by positions if two radars dispute it. Larger ones are
/// told by each radar's own positions (DopplerScale).
constexpr double kMaxDisputedScale = 0.05;
/// Decrease of chi-square by which one hypothesis is better than another.
constexpr double kClearlyBetter = 4.0;
/// First and longest time for which a radar stays at fault without new evidence: a mirrored mount
/// or a late bus shows in turns or when braking only.
constexpr std::int64_t kFirstHoldUs = 5'000'000;
constexpr std::int64_t kLongestHoldUs = 640'000'000;
/// The first of radars that found themselves wrong, if they are most.
constexpr std::int64_t kFirstSharedHoldUs = 500'000;

}  // namespace

void FaultHypotheses::Sums::add(const Eigen::Vector3d& derivative, double value, double variance) {
  information += derivative * derivative.transpose() / variance;
  weighted += derivative * (value / variance);
  squares += value * value / variance;
}

void FaultHypotheses::Sums::add(const Sums& other) {
  information += other.information;
  weighted += other.weighted;
  squares += other.squares;
}

Eigen::Vector3d FaultHypotheses::Sums::solution() const {
  return information.ldlt().solve(weighted);
}

double FaultHypotheses::Sums::chi_square() const {
  return std::max(0.0, squares - weighted.dot(solution()));
}

FaultHypotheses::FaultHypotheses(const OdometryState& state)
    : state_(state),
      tracks_(state.radars()),
      verdicts_(state.radars()),
      velocities_(state.radars()) {
  epochs_.fill(Epoch(state.radars()));
  for (std::size_t i = 0; i < state.radars(); ++i) {
    judged_ |= looks_across(state.mount(i)) ? 0U : 1U << i;
    causes_.emplace_back(state.mounts(), i);
  }
}

void FaultHypotheses::clear() {
  std::fill(tracks_.begin(), tracks_.end(), Track());
  for (FaultCauseSearch& cause : causes_) {
    cause.forget();
  }
  for (Verdict& verdict : verdicts_) {
    verdict.until_us.reset();
  }
  newest_us_ = std::numeric_limits<std::int64_t>::min();
  count_ = 0;
  unknown_epochs_ = 0;
  disputed_scale_ = 0.0;
}

std::uint32_t FaultHypotheses::at_fault() const {
  Set set = 0;
  for (std::size_t i = 0; i < verdicts_.size(); ++i) {
    set |= verdicts_[i].is_at_fault ? 1U << i : 0U;
  }
  return set;
}

void FaultHypotheses::add_speed_by_positions(std::size_t radar, std::int64_t stamp_us,
                                             double speed_mps, double since_s, double variance_m2) {
  const double of_method = squared(kPositionSpeedShare * speed_mps) +
                           squared(kPositionM / since_s) + squared(kPositionMps);
  tracks_[radar].speed =
      Speed{stamp_us, speed_mps, of_method + variance_m2 / squared(since_s), of_method};
}

void FaultHypotheses::add_too_few_targets(std::size_t radar, std::int64_t stamp_us) {
  tracks_[radar].too_few_targets_us = stamp_us;
}

void FaultHypotheses::add_motion(std::size_t radar, const EgoMotion& motion) {
  const double dt_s = seconds_between(motion.utime_start_us, motion.utime_us);
  if (!motion.has_estimate() || !(dt_s > 0.0)) {
    return;
  }
  auto& rates = tracks_[radar].yaw_rates;
  rates[0] = rates[1];
  rates[1] = {motion.utime_start_us, motion.utime_us, motion.motion.z() / dt_s,
              motion.covariance(2, 2) / squared(dt_s)};
}

void FaultHypotheses::add_velocity(std::size_t radar, std::int64_t stamp_us,
                                   const DopplerVelocity& velocity) {
  Track& track = tracks_[radar];
  track.velocities[0] = track.velocities[1];
  track.velocities[1] = {stamp_us, velocity.velocity_mps, velocity.covariance};
  track.count = std::min(track.count + 1, 2);
  newest_us_ = std::max(newest_us_, stamp_us);
  const auto time_us = common_time();
  if (time_us && (count_ == 0 || seconds_between(epoch_us_, *time_us) >= kEpochS)) {
    observe(*time_us);
    judge(*time_us);
  }
}

/// The latest time at which every radar that has scans can be interpolated.
std::optional<std::int64_t> FaultHypotheses::common_time() const {
  std::optional<std::int64_t> time_us;
  for (const Track& track : tracks_) {
    const std::int64_t last_us = track.velocities[1].stamp_us;
    if (track.count == 2 && seconds_between(last_us, newest_us_) <= kMaxScanPeriodS) {
      time_us = std::min(time_us.value_or(last_us), last_us);
    }
  }
  return time_us;
}

std::optional<FaultHypotheses::Velocity> FaultHypotheses::velocity_at(std::size_t radar,
                                                                      std::int64_t time_us) const {
  const Track& track = tracks_[radar];
  const Velocity& a = track.velocities[0];
  const Velocity& b = track.velocities[1];
  const double period_s = seconds_between(a.stamp_us, b.stamp_us);
  const Eigen::Vector2d possible_mps(
      kMaxAccelerationMps2 * period_s + kMaxNoiseMps,
      kMaxYawAccelerationRadps2 * std::abs(state_.mount(radar).x_m) * period_s + kMaxNoiseMps);
  const bool is_step = ((b.mps - a.mps).cwiseAbs().array() > possible_mps.array()).any();
  if (track.count < 2 || is_step || !(period_s > 0.0) || period_s > kMaxScanPeriodS ||
      std::abs(seconds_between(b.stamp_us, time_us)) > kMaxScanPeriodS) {
    return std::nullopt;
  }
  const double part = seconds_between(a.stamp_us, time_us) / period_s;
  return Velocity{time_us, a.mps + part * (b.mps - a.mps),
                  a.covariance + std::clamp(part, 0.0, 1.0) * (b.covariance - a.covariance)};
}

FaultHypotheses::Sums FaultHypotheses::by_doppler(std::size_t radar,
                                                  const Velocity& velocity) const {
  const OdometryOptions& options = state_.options();
  const Pose2& mount = state_.mount(radar);
  const bool is_witness = looks_across(mount);
  const double speed_mps = velocity.mps.norm();
  const double mount_std = options.mount_yaw_std_rad + kMoreMountYawStdRad +
                           (is_witness ? options.mount_yaw_across_std_rad : 0.0);
  Eigen::Matrix2d noise = velocity.covariance;
  noise(0, 0) += squared(options.doppler_x.std) + squared(options.offset.std) +
                 squared(options.common_scale_std * speed_mps) + squared(kBetweenScansMps);
  noise(1, 1) +=
      squared(options.doppler_y.std) + squared(kBetweenScansMps) + squared(mount_std * speed_mps);
  noise(0, 0) +=
      squared(is_witness ? kWitnessMps + kWitnessShare * speed_mps : disputed_scale_ * speed_mps);
  Eigen::Matrix<double, 2, kUnknowns> by;
  by << 1.0, -mount.y_m, 0.0, 0.0, mount.x_m, velocity.mps.x();
  const Eigen::Matrix2d weight = noise.inverse();
  Sums sums;
  sums.information = by.transpose() * weight * by;
  sums.weighted = by.transpose() * weight * velocity.mps;
  sums.squares = velocity.mps.dot(weight * velocity.mps);
  return sums;
}

FaultHypotheses::Sums FaultHypotheses::measurements(std::size_t radar, std::int64_t time_us,
                                                    const Velocity& velocity) const {
  Sums sums = by_doppler(radar, velocity);
  if ((judged_ >> radar & 1U) == 0) {
    return sums;
  }
  const Track& track = tracks_[radar];
  const Eigen::Vector3d along(1.0, -state_.mount(radar).y_m, 0.0);
  if (track.speed &&
      std::abs(seconds_between(track.speed->stamp_us, time_us)) <= kMaxPositionsAgeS) {
    sums.add(along, track.speed->mps, track.speed->variance);
  }
  for (const YawRate& rate : track.yaw_rates) {
    if (rate.start_us < time_us && time_us <= rate.end_us) {
      sums.add(Eigen::Vector3d::UnitY(), rate.radps,
               rate.variance + squared(kPositionYawRateRadps) +
                   squared(kPositionTurnShare * rate.radps));
    }
  }
  return sums;
}

void FaultHypotheses::observe(std::int64_t time_us) {
  if (count_ > 0 && std::abs(seconds_between(epoch_us_, time_us)) > 2.0 * kEpochs * kEpochS) {
    count_ = 0;
  }
  epoch_us_ = time_us;
  Epoch& epoch = epochs_[count_++ % kEpochs];
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    velocities_[i] = velocity_at(i, time_us);
    epoch[i] = velocities_[i] ? measurements(i, time_us, *velocities_[i]) : Sums();
  }
}

FaultHypotheses::Sums FaultHypotheses::prior() const {
  const OdometryOptions& options = state_.options();
  Sums prior;
  prior.add(Eigen::Vector3d::UnitX(), 0.0, squared(options.start_speed_std_mps));
  prior.add(Eigen::Vector3d::UnitY(), 0.0, squared(options.start_yaw_rate_std_radps));
  prior.add(Eigen::Vector3d::UnitZ(), 0.0, squared(options.slip_std_rad));
  return prior;
}

/// Of the radars in the set, with the prior.
FaultHypotheses::Sums FaultHypotheses::sum(Set set, const Epoch& epoch) const {
  Sums sum = prior();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if ((set >> i & 1U) != 0) {
      sum.add(epoch[i]);
    }
  }
  return sum;
}

/// Means over the epochs.
FaultHypotheses::Fit FaultHypotheses::fit(Set set) const {
  const std::size_t epochs = std::min(count_, kEpochs);
  Fit sum;
  for (std::size_t k = 0; k < epochs; ++k) {
    const Sums joint = this->sum(set, epochs_[k]);
    sum.of_set += joint.chi_square();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if ((judged_ >> i & 1U) == 0) {
        Sums with = joint;
        with.add(epochs_[k][i]);
        sum.of_witnesses += std::min(kMaxWitness, with.chi_square() - joint.chi_square());
      }
    }
  }
  return {sum.of_set / static_cast<double>(epochs), sum.of_witnesses / static_cast<double>(epochs)};
}

bool FaultHypotheses::is_consistent(Set set, double chi_square_of_set) const {
  const bool is_alone = std::has_single_bit(set);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Set without = set & ~(1U << i);
    if (without == set) {
      continue;
    }
    const double limit = verdicts_[i].is_at_fault ? kMaxDecreaseToReturn : kMaxDecrease;
    const double decrease = chi_square_of_set - (is_alone ? 0.0 : fit(without).chi_square());
    if (decrease > limit) {
      return false;
    }
  }
  return true;
}

void FaultHypotheses::try_set(Set set, Hypothesis& best) const {
  const double fit = this->fit(set).chi_square();
  if (!is_consistent(set, fit)) {
    return;
  }
  // Of two single radars that are each right by their own none is better.
  const double clearly_better =
      std::has_single_bit(set) ? std::numeric_limits<double>::infinity() : kClearlyBetter;
  if (best.set == 0 || fit < best.chi_square - clearly_better) {
    best = {set, fit, 0};
  } else if (fit > best.chi_square + clearly_better) {
    return;
  } else {
    best = {fit < best.chi_square ? set : best.set, std::min(fit, best.chi_square),
            best.rivals + 1};
  }
}

/// The witnesses contradict the best set by more than a radar may, and not this smaller one: two
/// exchanged radars, one ahead and one behind, agree that the vehicle drives backwards.
void FaultHypotheses::try_smaller(Set set, Hypothesis& best) const {
  const Fit fit = this->fit(set);
  const int fewer = std::popcount(best.set) - std::popcount(set);
  const double gain = this->fit(best.set).of_witnesses - fit.of_witnesses - kMaxDecrease * fewer;
  if (fewer <= 0 || gain <= 0.0 || !is_consistent(set, fit.chi_square())) {
    return;
  }
  best = gain > kClearlyBetter ? Hypothesis{set, fit.chi_square(), 0}
                               : Hypothesis{best.set, best.chi_square, best.rivals + 1};
}

/// The judged radars in the newest epoch.
FaultHypotheses::Set FaultHypotheses::present() const {
  Set present = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    present |= velocities_[i] ? judged_ & 1U << i : 0U;
  }
  return present;
}

/// The speeds of two radars or more, and of most, contradict their own positions: a fault that all
/// may share.
bool FaultHypotheses::contradict_positions() const {
  int refuted = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Track& track = tracks_[i];
    const Velocity& velocity = track.velocities[1];
    const bool is_compared =
        (present() >> i & 1U) != 0 && track.speed && track.speed->stamp_us == velocity.stamp_us;
    refuted += is_compared && squared(velocity.mps.x() - track.speed->mps) >
                                  squared(kMaxSpeedSigmas) * track.speed->variance
                   ? 1
                   : 0;
  }
  return refuted > 1 && 2 * refuted > std::popcount(present());
}

FaultHypotheses::Hypothesis FaultHypotheses::best_hypothesis() const {
  const Set present = this->present();
  if (present == 0) {
    return {judged_, 0.0, 0};
  }
  // That of before is kept while it explains the measurements.
  Hypothesis best;
  try_set(present, best);
  if (best.set == 0 && (present & ~at_fault()) != 0) {
    try_set(present & ~at_fault(), best);
  }
  if (best.set == 0 || (best.set != present && fit(best.set).of_witnesses > kMaxDecrease)) {
    best = search(present);
  }
  best.set |= best.set != 0 ? judged_ & ~present & ~at_fault() : 0U;
  return best;
}

/// The largest consistent sets with one or two radars less, or of one radar.
FaultHypotheses::Hypothesis FaultHypotheses::search(Set present) const {
  Hypothesis best;
  const auto each = [&](auto use) {
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      if ((present >> i & 1U) != 0) {
        use(1U << i);
      }
    }
  };
  const auto try_if_any = [&](Set set) {
    if (set != 0) {
      try_set(set, best);
    }
  };
  each([&](Set one) { try_if_any(present & ~one); });
  const auto each_pair = [&](auto use) {
    each([&](Set one) {
      each([&](Set other) { use(other > one ? present & ~one & ~other : 0U); });
    });
  };
  if (best.set == 0) {
    each_pair(try_if_any);
  }
  if (best.set == 0) {
    each(try_if_any);
  }
  if (best.set != 0 && fit(best.set).of_witnesses > kMaxDecrease) {
    const auto try_smaller = [&](Set set) {
      if (set != 0) {
        this->try_smaller(set, best);
      }
    };
    each_pair(try_smaller);
    each(try_smaller);
  }
  return best;
}

/// Whether positions confirm the speed of a radar in the set, or none has targets for that.
bool FaultHypotheses::is_supported(Set set, std::int64_t time_us) const {
  const auto is_fresh = [&](std::int64_t stamp_us) {
    return std::abs(seconds_between(stamp_us, time_us)) <= kMaxScanPeriodS;
  };
  bool has_targets = false;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Track& track = tracks_[i];
    if ((set >> i & 1U) == 0 || track.count < 2 || !is_fresh(track.velocities[1].stamp_us)) {
      continue;
    }
    if (track.speed && is_fresh(track.speed->stamp_us)) {
      const double limit_mps = kSupportingStdMps + kSupportingShare * std::abs(track.speed->mps);
      return track.speed->variance_of_method <= squared(limit_mps);
    }
    has_targets = has_targets || !(track.too_few_targets_us && is_fresh(*track.too_few_targets_us));
  }
  return !has_targets;
}

/// A radar that is wrong by itself has the Doppler of the set: the same is wrong with all.
bool FaultHypotheses::is_refuted(Set set, std::int64_t time_us) const {
  const Sums joint = sum(set, newest_epoch());
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Set one = 1U << i;
    if ((present() & one) == 0 || !is_wrong_by_itself(i, time_us)) {
      continue;
    }
    Sums with = joint;
    with.add((set & one) != 0 ? Sums() : by_doppler(i, *velocities_[i]));
    if (with.chi_square() - joint.chi_square() <= kMaxDecrease) {
      return true;
    }
  }
  return false;
}

/// Its positions contradict its Doppler. At rest all scans have the same map, which tells little;
/// then its own check counts, which while driving takes a second longer to end.
bool FaultHypotheses::is_wrong_by_itself(std::size_t radar, std::int64_t time_us) const {
  const auto accused_us = tracks_[radar].accused_us;
  const bool is_accused_at_rest =
      accused_us && std::abs(seconds_between(*accused_us, time_us)) <= kMaxScanPeriodS &&
      velocities_[radar]->mps.norm() < state_.options().standstill_mps;
  return is_accused_at_rest || !is_consistent(1U << radar, fit(1U << radar).chi_square());
}

/// A radar's own check says itself when a fault is over. One radar may be left out for longer; if
/// most are, there is no odometry.
void FaultHypotheses::accuse(std::size_t radar, std::int64_t time_us) {
  tracks_[radar].accused_us = time_us;
  convict(radar, time_us);
  verdicts_[radar].is_accused = true;
  if (2 * std::popcount(at_fault() & judged_) > std::popcount(judged_)) {
    verdicts_[radar].until_us = time_us + verdicts_[radar].shared_hold_us;
  }
}

/// At fault for some time after this evidence, each time twice as long.
void FaultHypotheses::convict(std::size_t radar, std::int64_t time_us) {
  Verdict& verdict = verdicts_[radar];
  if (!verdict.is_at_fault) {
    verdict.hold_us = std::clamp(2 * verdict.hold_us, kFirstHoldUs, kLongestHoldUs);
    verdict.shared_hold_us =
        std::clamp(2 * verdict.shared_hold_us, kFirstSharedHoldUs, kLongestHoldUs);
    is_newly_convicted_ = true;
  }
  verdict.is_at_fault = true;
  verdict.until_us = time_us + verdict.hold_us;
}

/// All of the set are at fault, and none found itself wrong.
bool FaultHypotheses::is_misjudged(Set set) const {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const bool is_in = ((set & present()) >> i & 1U) != 0;
    if (is_in && (!verdicts_[i].is_at_fault || verdicts_[i].is_accused)) {
      return false;
    }
  }
  return true;
}

/// The others convicted them, and are now found wrong themselves: so is what they told.
void FaultHypotheses::acquit(Set set) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    verdicts_[i].is_at_fault = verdicts_[i].is_at_fault && (set >> i & 1U) == 0;
  }
  is_reversed_ = true;
}

std::optional<Eigen::Vector3d> FaultHypotheses::take_correction() {
  const Set believed = present() & ~at_fault();
  if (!std::exchange(is_newly_convicted_, false) || count_ == 0 || believed == 0) {
    return std::nullopt;
  }
  return sum(believed, newest_epoch()).solution();
}

void FaultHypotheses::judge(std::int64_t time_us) {
  if (count_ < kMinEpochs) {
    return;
  }
  const Hypothesis best = best_hypothesis();
  const bool is_known =
      judged_ == 0 || (best.set != 0 && best.rivals == 0 && !contradict_positions());
  unknown_epochs_ = is_known ? 0 : unknown_epochs_ + 1;
  if (unknown_epochs_ == kMinEpochs && best.rivals > 0) {
    allow_for_scale();
    return;
  }
  const bool is_supported = is_known && this->is_supported(best.set, time_us) &&
                            !(needs_positions_ && is_refuted(best.set, time_us));
  supported_epochs_ = is_supported ? supported_epochs_ + 1 : 0;
  is_verified_ = (is_verified_ || supported_epochs_ >= kMinEpochs) && !is_unknown();
  if (is_known && (present() & ~at_fault() & ~best.set) != 0 && is_misjudged(best.set)) {
    acquit(best.set);
  }
  // Radars that all found themselves wrong may agree: with the same fault.
  const bool is_believed = is_known && (best.set & ~at_fault()) != 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    Verdict& verdict = verdicts_[i];
    verdict.until_us = verdict.until_us.value_or(time_us + verdict.hold_us);
    const bool is_judged = (judged_ >> i & 1U) != 0;
    const bool is_in = (best.set >> i & 1U) != 0;
    if (is_judged && is_believed && !is_in) {
      convict(i, time_us);
    } else if (time_us > *verdict.until_us) {
      verdict.is_at_fault = verdict.is_accused = false;
    }
  }
  if (is_known) {
    search_causes(best.set & ~at_fault(), time_us);
  }
}

/// If the only two radars differ by a few percent of the speed they are used as if each scale was
/// as uncertain as that, and judged anew.
void FaultHypotheses::allow_for_scale() {
  const Set present = this->present();
  if (disputed_scale_ > 0.0 || std::popcount(present) != 2 || (present & at_fault()) != 0) {
    return;
  }
  const Set one = present & ~(present - 1U);
  const double a_mps = sum(one, newest_epoch()).solution().x();
  const double b_mps = sum(present & ~one, newest_epoch()).solution().x();
  const double scale = std::abs(2.0 * (a_mps - b_mps) / (a_mps + b_mps));
  if (scale <= kMaxDisputedScale) {
    disputed_scale_ = scale;
    is_newly_disputed_ = true;
    count_ = 0;
    unknown_epochs_ = 0;
  }
}

/// Compares the radars at fault with the motion by those that are believed.
void FaultHypotheses::search_causes(Set believed, std::int64_t time_us) {
  if ((believed & present()) == 0) {
    return;
  }
  const Eigen::Vector3d motion = sum(believed, newest_epoch()).solution();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    causes_[i].add_motion(time_us, motion);
    if (!verdicts_[i].is_at_fault) {
      causes_[i].clear();
    } else if (velocities_[i]) {
      causes_[i].add_velocity(velocities_[i]->mps);
    }
  }
}

}  // namespace cremed
