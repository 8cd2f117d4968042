// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/motion_evidence.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "cremed/estimator/motion/vehicle_limits.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

constexpr double kEpochS = 0.15;
/// Largest difference of the times at which two radars see the same jump: a scan period.
constexpr double kMaxSkewS = 0.08;
/// Bound of the noise of a velocity's change. Larger steps are not interpolated.
constexpr double kMaxNoiseMps = 0.75;
/// Largest standard deviation of a speed by positions that confirms Doppler: 3 sigma are then 10 %.
constexpr double kSupportingStdMps = 0.1;
constexpr double kSupportingShare = 0.02;
/// Largest age of the speed by positions, in scan periods: of the same scan or the one before.
constexpr double kMaxPeriodsOfPositions = 1.2;
/// Error of a velocity that is interpolated linearly between two scans.
constexpr double kBetweenScansMps = 0.05;
/// Errors by positions: of the way, 1.1 % over 2 s on these drives, and that of one scan; of the
/// yaw rate, 0.1 to 0.35 degrees a second, and turns registered 1 to 4 % too small.
constexpr double kPositionSpeedShare = 0.01;
constexpr double kPositionM = 0.05;
/// Error of the state's speed, which they correct.
constexpr double kPositionMps = 0.05;
constexpr double kPositionYawRateRadps = 0.008;
constexpr double kPositionTurnShare = 0.03;
/// In addition to OdometryOptions: a mount measured by hand that is a degree off is learned.
constexpr double kMoreMountYawStdRad = 0.005;
/// Error of the speed along x of a radar that looks sideways: reflections on passed objects move.
constexpr double kWitnessMps = 0.5;
constexpr double kWitnessShare = 0.3;
/// Prior of the slip in a skid, or if mounts may be turned: 17 degrees.
constexpr double kAnySlipRad = 0.3;
/// Least number of epochs with an impossible slip: one may have a wrong registration.
constexpr int kMinImpossible = 2;
/// Limit of the difference of the speed by positions to that by Doppler: this share of the speed,
/// and this much. Of the one of three or two radars that differs least, healthy ones reach 0.7 of
/// it (means of 0.45 s of three, of 1 s of two), with scales of 0.95 and 1.05 at least 1.1 in the
/// first second.
constexpr double kMinScaleShare = 0.02;
constexpr double kMinScaleMps = 0.04;
/// Below it Doppler's rounding, slow cars among the static targets, and what a late radar did to
/// the state shift the speed by 0.2 m/s and more (0103, 1094).
constexpr double kMinScaledMps = 4.0;
/// Lateral acceleration of turns, which bounds the yaw rate: slow vehicles turn faster than the
/// prior at a start allows. With that prior alone a U-turn at full lock (0.85 rad/s) contradicts a
/// lone radar by 8.
constexpr double kTurnStdMps2 = 3.0;
constexpr double kMaxTurnStdRadps = 3.0;

}  // namespace

MotionEvidence::MotionEvidence(const OdometryState& state)
    : state_(state), tracks_(state.radars()) {
  epochs_.fill(Epoch(state.radars()));
}

void MotionEvidence::clear() {
  for (Track& track : tracks_) {
    const bool is_after_step = track.is_after_step;
    track = Track();
    track.is_after_step = is_after_step;
  }
  newest_us_ = std::numeric_limits<std::int64_t>::min();
  count_ = 0;
  disputed_scale_ = 0.0;
}

void MotionEvidence::add_speed_by_positions(std::size_t radar, std::int64_t stamp_us,
                                            double speed_mps, double since_s, double variance_m2) {
  const double of_method = squared(kPositionSpeedShare * speed_mps) +
                           squared(kPositionM / since_s) + squared(kPositionMps) +
                           squared(state_.mixture_std());
  tracks_[radar].speed =
      Speed{stamp_us, speed_mps, of_method + variance_m2 / squared(since_s), of_method, since_s};
}

void MotionEvidence::add_motion(std::size_t radar, const EgoMotion& motion) {
  const double dt_s = seconds_between(motion.utime_start_us, motion.utime_us);
  if (!motion.has_estimate() || !(dt_s > 0.0)) {
    return;
  }
  auto& rates = tracks_[radar].yaw_rates;
  rates[0] = rates[1];
  const YawByPositions& yaw = motion.by_positions;
  // The registration used the mount of the configuration. If that is turned, its yaw rate is wrong;
  // by positions alone it is not.
  const double yaw_rad =
      state_.is_turned(radar) ? std::numeric_limits<double>::quiet_NaN() : motion.motion.z();
  rates[1] = {motion.utime_start_us, motion.utime_us,
              yaw_rad / dt_s,        motion.covariance(2, 2) / squared(dt_s),
              yaw.rad / dt_s,        yaw.variance_rad2 / squared(dt_s)};
}

bool MotionEvidence::add_velocity(std::size_t radar, std::int64_t stamp_us,
                                  const DopplerVelocity& velocity) {
  Track& track = tracks_[radar];
  track.velocities[0] = track.velocities[1];
  // Each radar sees other cars.
  track.velocities[1] = {
      stamp_us, velocity.velocity_mps,
      velocity.covariance + squared(state_.mixture_std()) * Eigen::Matrix2d::Identity()};
  track.count = std::min(track.count + 1, 2);
  if (const auto jump = track.jumps.add(stamp_us, velocity)) {
    track.jump = jump;
  }
  const bool jumps_back = track.jump && step_mps_ && reverses(track.jump->change_mps(), *step_mps_);
  if (track.is_after_step && (jumps_back || is_step(radar))) {
    track.is_after_step = false;
    track.jump.reset();
    has_stepped_back_ = !is_after_step(judged());
    count_ = has_stepped_back_ ? 0 : count_;
  }
  newest_us_ = std::max(newest_us_, stamp_us);
  const auto time_us = common_time();
  const bool is_due = time_us && (count_ == 0 || seconds_between(time_us_, *time_us) >= kEpochS);
  if (is_due) {
    observe(*time_us);
  }
  return is_due;
}

void MotionEvidence::set_after_step(std::optional<double> step_mps) {
  step_mps_ = step_mps;
  for (Track& track : tracks_) {
    track.is_after_step = step_mps.has_value();
  }
}

bool MotionEvidence::is_after_step(RadarSet set) const {
  return any_of(set & heard(), [&](std::size_t i) { return tracks_[i].is_after_step; });
}

RadarSet MotionEvidence::take_jumped() {
  const RadarSet jumped =
      filter(judged(), [&](std::size_t i) { return tracks_[i].jump.has_value(); });
  if (jumped == 0) {
    return 0;
  }
  std::int64_t last_us = std::numeric_limits<std::int64_t>::min();
  for_each(jumped, [&](std::size_t i) { last_us = std::max(last_us, tracks_[i].jump->stamp_us); });
  const RadarSet heard = this->heard() & judged();
  const RadarSet others = heard & ~jumped;
  if (any_of(others, [&](std::size_t i) {
        return seconds_between(last_us, tracks_[i].velocities[0].stamp_us) < kMaxSkewS;
      })) {
    return 0;
  }
  if (heard == jumped && std::has_single_bit(heard)) {
    lone_jump_ = tracks_[static_cast<std::size_t>(std::countr_zero(heard))].jump;
  }
  for_each(jumped, [&](std::size_t i) { tracks_[i].jump.reset(); });
  // A kerb jolts the vehicle, and all radars see it. So the jump is the radar's fault only if
  // another radar measured a steady speed.
  return any_of(others, [&](std::size_t i) { return tracks_[i].jumps.is_steady(last_us); }) ? jumped
                                                                                            : 0U;
}

RadarSet MotionEvidence::heard() const {
  return filter(first_radars(tracks_.size()), [&](std::size_t i) {
    return tracks_[i].count > 0 &&
           seconds_between(tracks_[i].velocities[1].stamp_us, newest_us_) <= kMaxScanPeriodS;
  });
}

/// The velocity changed by more than the vehicle's can between the two newest scans.
bool MotionEvidence::is_step(std::size_t radar) const {
  const auto& [a, b] = tracks_[radar].velocities;
  const double period_s = seconds_between(a.stamp_us, b.stamp_us);
  const Eigen::Vector2d possible_mps(
      kMaxAccelerationMps2 * period_s + kMaxNoiseMps,
      kMaxYawAccelerationRadps2 * std::abs(state_.mount(radar).x_m) * period_s + kMaxNoiseMps);
  return tracks_[radar].count == 2 &&
         ((b.mps - a.mps).cwiseAbs().array() > possible_mps.array()).any();
}

/// The latest time at which every radar that has scans can be interpolated.
std::optional<std::int64_t> MotionEvidence::common_time() const {
  std::optional<std::int64_t> time_us;
  for_each(heard(), [&](std::size_t i) {
    const std::int64_t last_us = tracks_[i].velocities[1].stamp_us;
    if (tracks_[i].count == 2) {
      time_us = std::min(time_us.value_or(last_us), last_us);
    }
  });
  return time_us;
}

void MotionEvidence::observe(std::int64_t time_us) {
  if (count_ > 0 && seconds_between(time_us_, time_us) > 2.0 * kEpochs * kEpochS) {
    count_ = 0;
  }
  time_us_ = time_us;
  Epoch& epoch = epochs_[count_++ % kEpochs];
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const auto velocity = velocity_at(i, time_us);
    epoch[i] = {velocity, {}, {}, {}};
    if (velocity) {
      epoch[i].speed_by_positions = speed_by_positions(i);
      epoch[i].all = measurements(i, epoch[i], Slip::usual);
      epoch[i].all_by_positions = measurements(i, epoch[i], Slip::usual_by_positions);
    }
  }
}

bool MotionEvidence::is_fresh(std::int64_t stamp_us) const {
  return std::abs(seconds_between(stamp_us, time_us_)) <= kMaxScanPeriodS;
}

std::optional<MotionEvidence::Velocity> MotionEvidence::velocity_at(std::size_t radar,
                                                                    std::int64_t time_us) const {
  const Track& track = tracks_[radar];
  const auto& [a, b] = track.velocities;
  const double period_s = seconds_between(a.stamp_us, b.stamp_us);
  if (track.count < 2 || is_step(radar) || !(period_s > 0.0) || period_s > kMaxScanPeriodS ||
      !is_fresh(b.stamp_us)) {
    return std::nullopt;
  }
  const double part = seconds_between(a.stamp_us, time_us) / period_s;
  if (part < -1.0 || part > 1.0) {
    return std::nullopt;
  }
  const double of_a = 1.0 - part;
  return Velocity{
      time_us, of_a * a.mps + part * b.mps,
      std::max(of_a, squared(of_a)) * a.covariance + std::max(part, squared(part)) * b.covariance};
}

MotionSums MotionEvidence::by_doppler(std::size_t mount_of, const Velocity& velocity) const {
  const OdometryOptions& options = state_.options();
  const Pose2& mount = state_.mount(mount_of);
  const bool is_witness = looks_across(mount);
  const double speed_mps = velocity.mps.norm();
  const LearnedErrors prior = unlearned_errors(options, mount);
  const int mount_yaw = state_.error(mount_of, state_layout::kMountYaw);
  const bool is_turned = state_.is_turned(mount_of);
  const double turned_rad = state_.turned_rad(mount_of);
  const double mount_std =
      (is_turned ? state_.gaussian.std(mount_yaw) : prior.mount_yaw_rad.std) + kMoreMountYawStdRad;
  // As uncertain as the filter has them, also of radars off the axis of travel, of which a scale of
  // azimuths changes the speed. Otherwise one of four corner radars with a Doppler scale of 1.04
  // had three healthy ones found at fault, on a simulated motorway.
  const double scale_std = std::max(options.common_scale_std, prior.doppler_scale.std);
  Eigen::Matrix2d noise = velocity.covariance;
  noise(0, 0) += squared(options.doppler_x.std) + squared(options.offset.std) +
                 squared(scale_std * speed_mps) + squared(kBetweenScansMps);
  noise(1, 1) +=
      squared(options.doppler_y.std) + squared(kBetweenScansMps) + squared(mount_std * speed_mps);
  noise(0, 0) +=
      squared(is_witness ? kWitnessMps + kWitnessShare * speed_mps : disputed_scale_ * speed_mps);
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd(turned_rad).toRotationMatrix();
  MotionSums sums;
  sums.add_velocity(mount, turn * velocity.mps, turn * noise * turn.transpose(),
                    turn * velocity.covariance * turn.transpose());
  return sums;
}

/// At the time of the epoch.
std::optional<MotionEvidence::Speed> MotionEvidence::speed_by_positions(std::size_t radar) const {
  const Track& track = tracks_[radar];
  const auto& [a, b] = track.velocities;
  const double part = !track.speed ? 0.0
                                   : seconds_between(track.speed->stamp_us, time_us_) /
                                         seconds_between(a.stamp_us, b.stamp_us);
  if (!track.speed || std::abs(part) > kMaxPeriodsOfPositions) {
    return std::nullopt;
  }
  Speed speed = *track.speed;
  speed.mps += part * (b.mps - a.mps).x();
  speed.variance += squared(part) * (a.covariance + b.covariance)(0, 0);
  return speed;
}

/// Of a radar with a velocity.
MotionSums MotionEvidence::measurements(std::size_t radar, const Measured& measured,
                                        Slip slip) const {
  MotionSums sums = by_doppler(radar, *measured.velocity);
  if (!contains(judged(), radar)) {
    return sums;
  }
  const Track& track = tracks_[radar];
  const Eigen::Vector3d along(1.0, -state_.mount(radar).y_m, 0.0);
  if (const auto& speed = measured.speed_by_positions) {
    sums.add(along, speed->mps, speed->variance,
             track.speed->variance - track.speed->variance_of_method);
  }
  for (const YawRate& rate : track.yaw_rates) {
    const double radps = slip == Slip::usual ? rate.radps : rate.by_positions_radps;
    const double variance = slip == Slip::usual ? rate.variance : rate.variance_by_positions;
    if (rate.start_us < time_us_ && time_us_ <= rate.end_us && std::isfinite(radps)) {
      sums.add(Eigen::Vector3d::UnitY(), radps,
               variance + squared(kPositionYawRateRadps) + squared(kPositionTurnShare * radps),
               variance);
    }
  }
  return sums;
}

MotionSums MotionEvidence::prior(double yaw_rate_std_radps) const {
  const OdometryOptions& options = state_.options();
  MotionSums prior;
  prior.add(Eigen::Vector3d::UnitX(), 0.0, squared(options.start_speed_std_mps));
  prior.add(Eigen::Vector3d::UnitY(), 0.0, squared(yaw_rate_std_radps));
  return prior;
}

/// Prior of the slip, -k v w with an error that grows in the turn, as in the filter. Speed and turn
/// are those of the solution with the slip of straight driving.
void MotionEvidence::add_slip(MotionSums& sum, Slip slip) const {
  const OdometryOptions& options = state_.options();
  if (slip == Slip::any) {
    sum.add(Eigen::Vector3d::UnitZ(), 0.0, squared(kAnySlipRad));
    return;
  }
  MotionSums straight = sum;
  straight.add(Eigen::Vector3d::UnitZ(), 0.0, squared(options.slip_std_rad));
  const Eigen::Vector3d motion = straight.solution();
  const double across_mps2 = std::min(std::abs(motion.x() * motion.y()), kMaxAccelerationMps2);
  const Eigen::Vector3d by_turn(0.0, options.slip_per_lateral_acceleration * motion.x(), 1.0);
  sum.add(by_turn, 0.0,
          squared(options.slip_std_rad) +
              squared(options.slip_per_lateral_acceleration_std * across_mps2));
}

/// Prior of the yaw rate at the mean speed of the judged radars.
double MotionEvidence::turn_std_radps(const Epoch& epoch) const {
  double speeds_mps = 0.0;
  double count = 0.0;
  for_each(judged(), [&](std::size_t i) {
    speeds_mps += epoch[i].velocity ? epoch[i].velocity->mps.norm() : 0.0;
    count += epoch[i].velocity ? 1.0 : 0.0;
  });
  const double least_radps = state_.options().start_yaw_rate_std_radps;
  return speeds_mps * kMaxTurnStdRadps > kTurnStdMps2 * count
             ? std::max(least_radps, kTurnStdMps2 * count / speeds_mps)
             : kMaxTurnStdRadps;
}

MotionSums MotionEvidence::by_doppler_at(std::size_t radar, std::size_t mount,
                                         const std::optional<Velocity>& velocity) const {
  if (!velocity) {
    return {};
  }
  const Eigen::Matrix2d turn =
      Eigen::Rotation2Dd(state_.mount(mount).yaw_rad - state_.mount(radar).yaw_rad)
          .toRotationMatrix();
  return by_doppler(mount, {velocity->stamp_us, turn * velocity->mps,
                            turn * velocity->covariance * turn.transpose()});
}

MotionSums MotionEvidence::sum(RadarSet set, const Epoch& epoch, std::optional<Pair> pair,
                               double yaw_rate_std_radps, Slip slip) const {
  MotionSums sum = prior(yaw_rate_std_radps);
  for_each(set, [&](std::size_t i) {
    if (pair && (i == pair->one || i == pair->other)) {
      const std::size_t partner = i == pair->one ? pair->other : pair->one;
      sum.add(by_doppler_at(i, pair->is_exchanged ? partner : i, epoch[i].velocity));
    } else {
      sum.add(slip == Slip::usual ? epoch[i].all : epoch[i].all_by_positions);
    }
  });
  add_slip(sum, slip);
  return sum;
}

MotionSums MotionEvidence::sum_by_doppler(RadarSet set) const {
  MotionSums sum = prior(state_.options().start_yaw_rate_std_radps);
  for_each(set, [&](std::size_t i) { sum.add(by_doppler(i)); });
  add_slip(sum, Slip::usual);
  return sum;
}

MotionEvidence::MotionWithSlip MotionEvidence::motion_with_slip(RadarSet set) const {
  MotionWithSlip result{Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity()};
  for (std::size_t k = 0; k < epochs(); ++k) {
    const Eigen::Vector3d motion =
        sum(set, epochs_[k], {}, turn_std_radps(epochs_[k]), Slip::any).solution();
    result.mean += motion / static_cast<double>(epochs());
    result.least_slip_rad = std::min(result.least_slip_rad, motion.z());
    result.largest_slip_rad = std::max(result.largest_slip_rad, motion.z());
  }
  return result;
}

std::optional<Eigen::Vector3d> MotionEvidence::motion_with_impossible_slip() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (std::size_t k = 0; k < epochs(); ++k) {
    const double std_radps = turn_std_radps(epochs_[k]);
    const MotionSums usual =
        this->sum(present(), epochs_[k], {}, std_radps, Slip::usual_by_positions);
    const MotionSums any = this->sum(present(), epochs_[k], {}, std_radps, Slip::any);
    if (usual.chi_square() - any.chi_square() > kDecreaseByImpossibleSlip) {
      sum += any.solution();
      ++count;
    }
  }
  return count >= kMinImpossible ? std::optional<Eigen::Vector3d>(sum / count) : std::nullopt;
}

MotionEvidence::Fit MotionEvidence::fit(RadarSet set, const Epoch& epoch, std::optional<Pair> pair,
                                        Slip slip) const {
  const MotionSums joint = sum(set, epoch, pair, turn_std_radps(epoch), slip);
  Fit fit{joint.chi_square()};
  int heard = 0;
  for_each(witnesses(), [&](std::size_t i) {
    MotionSums with = joint;
    with.add(epoch[i].all);
    const double of_witness = std::min(kMaxWitness, with.chi_square() - fit.of_set);
    fit.of_witnesses += of_witness;
    fit.of_worst_witness = std::max(fit.of_worst_witness, of_witness);
    heard += epoch[i].velocity.has_value();
  });
  fit.of_worst_witness = heard > 1 ? fit.of_worst_witness : 0.0;
  return fit;
}

MotionEvidence::Fit MotionEvidence::fit(RadarSet set, std::optional<Pair> pair, Slip slip) const {
  Fit sum;
  for (std::size_t k = 0; k < epochs(); ++k) {
    const Fit of_epoch = fit(set, epochs_[k], pair, slip);
    sum.of_set += of_epoch.of_set;
    sum.of_witnesses += of_epoch.of_witnesses;
  }
  const auto count = static_cast<double>(epochs());
  return {sum.of_set / count, sum.of_witnesses / count};
}

MotionEvidence::ChiSquares MotionEvidence::chi_squares(RadarSet set, std::optional<Pair> pair,
                                                       Slip slip) const {
  const bool is_lone = std::has_single_bit(set) && set == present();
  ChiSquares result{};
  for (std::size_t k = 0; set != 0 && k < epochs(); ++k) {
    const Fit of_epoch = fit(set, epochs_[k], pair, slip);
    // Against a lone radar several witnesses must agree: one of them may see a passing vehicle.
    result[k] = of_epoch.chi_square() - (is_lone ? of_epoch.of_worst_witness : 0.0);
  }
  return result;
}

MotionEvidence::SpeedDifference MotionEvidence::speed_difference(std::size_t radar,
                                                                 RadarSet set) const {
  const Eigen::Vector3d along(1.0, -state_.mount(radar).y_m, 0.0);
  double speeds_mps = 0.0;
  double differences_mps = 0.0;
  double variances = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < epochs(); ++k) {
    const Epoch& epoch = epochs_[k];
    const auto& velocity = epoch[radar].velocity;
    if (velocity && !any_of(set, [&](std::size_t i) { return !epoch[i].velocity; })) {
      const MotionSums others =
          sum(set, epoch, {}, state_.options().start_yaw_rate_std_radps, Slip::usual);
      speeds_mps += velocity->mps.x();
      differences_mps += velocity->mps.x() - along.dot(others.solution());
      variances += velocity->covariance(0, 0) + along.dot(others.random_covariance() * along);
      count += 1.0;
    }
  }
  if (count == 0.0) {
    return {};
  }
  return {speeds_mps / count, differences_mps / count, std::sqrt(variances) / count};
}

std::optional<double> MotionEvidence::scale_by_positions(std::size_t radar, std::size_t newest,
                                                         double min_since_s, double limits) const {
  double by_doppler_mps = 0.0;
  double by_positions_mps = 0.0;
  std::size_t count = 0;
  for (std::size_t age = 0; age < std::min(newest, epochs()); ++age) {
    const Measured& measured = epochs_[(count_ - 1 - age) % kEpochs][radar];
    if (measured.velocity && measured.speed_by_positions &&
        measured.speed_by_positions->since_s >= min_since_s) {
      by_doppler_mps += measured.velocity->mps.x();
      by_positions_mps += measured.speed_by_positions->mps;
      ++count;
    }
  }
  const auto measured = static_cast<double>(count);
  const double sum_mps = std::abs(by_doppler_mps);
  const bool differs = 2 * count > newest && sum_mps > kMinScaledMps * measured &&
                       std::abs(by_positions_mps - by_doppler_mps) >
                           limits * (kMinScaleShare * sum_mps + kMinScaleMps * measured);
  return differs ? std::optional(by_positions_mps / by_doppler_mps) : std::nullopt;
}

RadarSet MotionEvidence::present() const {
  return filter(judged(), [&](std::size_t i) { return velocity(i).has_value(); });
}

bool MotionEvidence::is_supported(RadarSet set) const {
  bool has_targets = false;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Track& track = tracks_[i];
    if (!contains(set, i) || track.count < 2 || !is_fresh(track.velocities[1].stamp_us)) {
      continue;
    }
    if (track.speed && is_fresh(track.speed->stamp_us)) {
      const double limit_mps = kSupportingStdMps + kSupportingShare * std::abs(track.speed->mps);
      if (track.speed->variance_of_method <= squared(limit_mps)) {
        return true;
      }
      has_targets = true;
    }
    has_targets = has_targets || !(track.too_few_targets_us && is_fresh(*track.too_few_targets_us));
  }
  return !has_targets;
}

}  // namespace cremed
