// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/fused_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/acceleration.hpp"
#include "estimator/normal_equations.hpp"
#include "estimator/shared_doppler.hpp"
#include "estimator/stamps.hpp"

namespace cremed {
namespace {

/// A radar that says nothing for this long does not lead: several cycles.
constexpr std::int64_t kSilenceUs = 250'000;

/// Sideways motion of a radar that cannot tell.
constexpr double kUnknownM = 1.0;
/// Squared and in standard deviations: farther away a radar's equations do not hold.
constexpr double kFarthestSquared = 25.0;
/// How well a vehicle that stands is known not to slip, so that nothing becomes infinite.
constexpr double kLeastSlipMps = 1e-3;
/// Slower than this a car shows no slip.
constexpr double kLeastRollingMps = 1.0;

Eigen::Matrix3d outer(const Eigen::Vector3d& v) { return v * v.transpose(); }

}  // namespace

void FusedEstimator::Sums::add(const Eigen::Matrix3d& more, const Eigen::Vector3d& mean) {
  information += more;
  weighted += more * mean;
}

FusedEstimator::FusedEstimator(const FusedOptions& options, const EgoMotionOptions& first,
                               std::size_t radars)
    : options_(options),
      first_(first),
      radars_(std::min(radars, kMaxFusedRadars)),
      leader_(radars_),
      slip_variance_rad2_(options.side_slip_std_rad * options.side_slip_std_rad) {}

void FusedEstimator::forget() {
  count_ = 0;
  leader_ = radars_;
  has_end_ = false;
  has_last_ = false;
}

std::optional<EgoMotion> FusedEstimator::update(std::size_t radar, const EgoMotion& motion,
                                                bool is_believed) {
  if (has_end_ && motion.has_estimate()) {
    note(radar, motion, is_believed);
  }
  if (!leads(radar, motion.utime_us)) {
    return std::nullopt;
  }
  const double since_s = has_end_ ? seconds_between(end_us_, motion.utime_us) : 0.0;
  if (has_end_ && since_s <= 0.0 && since_s >= -first_.max_gap_s) {
    return std::nullopt;  // Another radar led meanwhile, and its scan was later.
  }
  EgoMotion fused;
  fused.utime_us = motion.utime_us;
  fused.utime_start_us = has_end_ ? end_us_ : motion.utime_us;
  const double dt_s = seconds_between(fused.utime_start_us, fused.utime_us);
  if (!has_end_ || (!has_last_ && count_ == 0)) {
    fused.status = MotionStatus::no_reference;
  } else if (!(dt_s > 0.0 && dt_s <= first_.max_gap_s)) {
    fused.status = MotionStatus::gap_too_long;
  } else {
    fused.status = count_ == 0 ? motion.status : fuse(dt_s, fused);
    if (!fused.has_estimate()) {
      fused.motion.setConstant(EgoMotion::kNothing);
      fused.covariance.setConstant(EgoMotion::kNothing);
      return fused;  // The next one spans this interval too.
    }
  }
  has_last_ = fused.has_estimate();
  count_ = 0;
  end_us_ = fused.utime_us;
  has_end_ = true;
  return fused;
}

/// The first radar that is alive leads: its scans end the fused motions.
bool FusedEstimator::leads(std::size_t radar, std::int64_t utime_us) {
  last_scan_us_[radar] = utime_us;
  if (radar < leader_ || seconds_between(last_scan_us_[leader_], utime_us) * 1e6 > kSilenceUs) {
    leader_ = radar;
  }
  return radar == leader_;
}

/// Keeps a motion for the next fused one.
void FusedEstimator::note(std::size_t radar, const EgoMotion& motion, bool is_believed) {
  if (count_ == kMaxMotions) {
    std::move(measurements_.begin() + 1, measurements_.end(), measurements_.begin());
    --count_;
  }
  agreements_[radar].innovation.pass(motion.utime_us);
  agreements_[radar].judge();
  const double dt_s = seconds_between(motion.utime_start_us, motion.utime_us);
  Measurement& m = measurements_[count_++];
  m.radar = radar;
  m.is_believed = is_believed;
  m.status = motion.status;
  m.targets = motion.targets;
  m.twist.middle_s = seconds_between(end_us_, motion.utime_us) - 0.5 * dt_s;
  Eigen::Vector3d free = motion.motion;
  const auto complete = invert_information(motion.information, 3);
  if (complete && motion.gradient.dot(*complete * motion.gradient) < kFarthestSquared) {
    free -= *complete * motion.gradient;
    m.twist.covariance = *complete;
  } else {
    // Of a car that moves sideways: its yaw would pay for y = 0.
    m.is_believed = is_believed && !complete;
    m.twist.covariance = motion.covariance;
    m.twist.covariance(1, 1) = kUnknownM * kUnknownM;
  }
  free.y() -= 0.5 * free.x() * free.z();
  m.twist.mean = free / dt_s;
  m.twist.covariance /= dt_s * dt_s;
  const SharedErrorOptions& errors = first_.registration.shared_errors;
  m.twist.covariance += outer(m.twist.mean * (errors.stamp_std_s / dt_s));
}

MotionStatus FusedEstimator::fuse(double dt_s, EgoMotion& fused) {
  weigh(dt_s);
  if (used() == 0) {
    return MotionStatus::ambiguous;
  }
  Contradiction worst = contradiction(known_before(dt_s));
  while (worst.is_any && worst.is_plain) {
    leave_out(worst.radar);
    worst = contradiction(known_before(dt_s));
  }
  note_agreement(known_before(dt_s));
  if (worst.is_any) {  // The next one begins here: a longer interval would be no clearer.
    count_ = 0;
    end_us_ = fused.utime_us;
    last_.middle_s -= dt_s;
    return MotionStatus::ambiguous;
  }
  const Sums sums = sum_of_used();
  const auto covariance = invert_information(sums.information, 3);
  if (!covariance) {
    return MotionStatus::degenerate;
  }
  finish(dt_s, {*covariance * sums.weighted, *covariance, 0.5 * dt_s}, fused);
  const Eigen::Vector3d sigma = fused.covariance.diagonal().cwiseSqrt();
  if (!fused.motion.allFinite() || !fused.covariance.allFinite()) {
    return MotionStatus::non_finite;
  }
  if (sigma.head<2>().maxCoeff() > first_.max_std_m || sigma.z() > first_.max_std_rad) {
    return MotionStatus::degenerate;
  }
  const bool stands = std::all_of(
      measurements_.begin(), measurements_.begin() + static_cast<std::ptrdiff_t>(count_),
      [](const Measurement& m) { return !m.is_used || m.status == MotionStatus::standing_still; });
  const bool is_slow = fused.motion.head<2>().norm() <= first_.standstill_mps * dt_s;
  return stands && is_slow ? MotionStatus::standing_still : MotionStatus::ok;
}

/// How much each motion says about the interval; those of radars that are not believed nothing.
void FusedEstimator::weigh(double dt_s) {
  for (std::size_t i = 0; i < count_; ++i) {
    Measurement& m = measurements_[i];
    m.covariance =
        m.twist.covariance + acceleration_covariance(m.twist.middle_s - 0.5 * dt_s,
                                                     options_.acceleration_std_mps2,
                                                     options_.yaw_acceleration_std_radps2);
    const auto information = invert_information(m.covariance, 3);
    m.information = information.value_or(Eigen::Matrix3d::Zero());
    m.is_used = information && m.is_believed && !agreements_[m.radar].contradicts;
  }
  const auto end = measurements_.begin() + static_cast<std::ptrdiff_t>(count_);
  const bool is_one_wrong =
      std::any_of(measurements_.begin(), end, [](const Measurement& m) { return !m.is_believed; });
  if (used() == 0 && is_one_wrong) {
    // Then those were right that contradicted it.
    std::for_each(measurements_.begin(), end, [this](Measurement& m) {
      m.is_used = m.is_believed && !m.information.isZero(0.0);
      if (m.is_believed) {
        agreements_[m.radar].forgive();
      }
    });
  }
}

/// What is known before of a car's sideways velocity, at the speed that the used motions tell: that
/// of one which is wrong would make slip grow from one fused motion to the next.
FusedEstimator::Sums FusedEstimator::prior() const {
  Sums sums;
  if (first_.registration.degrees_of_freedom == 2) {
    const double velocity_mps = this->velocity_mps();
    const double variance =
        std::max(slip_variance_rad2_ * velocity_mps * velocity_mps, kLeastSlipMps * kLeastSlipMps);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    information(1, 1) = 1.0 / variance;
    sums.add(information, {0.0, slip_rad_ * velocity_mps, 0.0});
  }
  return sums;
}

/// Slip shows better the faster the car is.
void FusedEstimator::learn_slip(double dt_s, const Twist& twist) {
  const double velocity_mps = twist.mean.x();
  const double initial = options_.side_slip_std_rad * options_.side_slip_std_rad;
  const double walk = options_.side_slip_walk_radps * options_.side_slip_walk_radps * dt_s;
  if (std::abs(velocity_mps) > kLeastRollingMps) {
    slip_rad_ = twist.mean.y() / velocity_mps;
    slip_variance_rad2_ = twist.covariance(1, 1) / (velocity_mps * velocity_mps);
  }
  slip_variance_rad2_ = std::min(slip_variance_rad2_ + walk, initial);
}

FusedEstimator::Sums FusedEstimator::sum_of_used() const {
  return sum_of_others(radars_, prior());  // No radar has this number.
}

/// What is known without the radars' motions: of slip, and what the vehicle did before, which it
/// may have changed since.
FusedEstimator::Sums FusedEstimator::known_before(double dt_s) const {
  Sums sums = prior();
  if (has_last_) {
    const SharedErrorOptions& errors = first_.registration.shared_errors;
    const auto information = invert_information(
        last_.covariance + acceleration_covariance(0.5 * dt_s - last_.middle_s,
                                                   errors.acceleration_std_mps2,
                                                   errors.yaw_acceleration_std_radps2),
        3);
    sums.add(information.value_or(Eigen::Matrix3d::Zero()), last_.mean);
  }
  return sums;
}

void FusedEstimator::finish(double dt_s, const Twist& twist, EgoMotion& fused) {
  last_ = twist;
  last_.middle_s = -0.5 * dt_s;  // As seen from the end.
  const Eigen::Vector3d moved = twist.mean * dt_s;
  fused.motion = moved;
  fused.motion.y() += 0.5 * moved.x() * moved.z();
  Eigen::Matrix3d arc = Eigen::Matrix3d::Identity();
  arc(1, 0) = 0.5 * moved.z();
  arc(1, 2) = 0.5 * moved.x();
  const Eigen::Matrix3d covariance = arc * twist.covariance * arc.transpose() * (dt_s * dt_s);
  fused.covariance = 0.5 * (covariance + covariance.transpose());
  const double velocity_m = rolling_part(moved, std::sqrt(fused.covariance(0, 0)), dt_s) *
                            first_.registration.shared_errors.velocity_std_mps * dt_s;
  fused.covariance(0, 0) += velocity_m * velocity_m;
  if (first_.registration.degrees_of_freedom == 3) {
    fused.covariance(1, 1) += velocity_m * velocity_m;
  } else {
    learn_slip(dt_s, twist);
    const double mounts_m = moved.x() * first_.registration.shared_errors.mount_yaw_std_rad;
    int radars = 0;  // Two motions of one radar err alike.
    for (std::size_t radar = 0; radar < radars_; ++radar) {
      radars += own_sum(radar).information.isZero(0.0) ? 0 : 1;
    }
    fused.covariance(1, 1) += mounts_m * mounts_m / std::max(radars, 1);
  }
  for (std::size_t i = 0; i < count_; ++i) {
    fused.targets += measurements_[i].is_used ? measurements_[i].targets : 0;
    fused.iterations += measurements_[i].is_used ? 1 : 0;
  }
}

/// Along x, by the radar that is most certain of it.
double FusedEstimator::velocity_mps() const {
  double velocity_mps = 0.0;
  double most = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Measurement& m = measurements_[i];
    if (m.is_used && m.information(0, 0) > most) {
      most = m.information(0, 0);
      velocity_mps = m.twist.mean.x();
    }
  }
  return velocity_mps;
}

std::size_t FusedEstimator::used() const {
  return static_cast<std::size_t>(std::count_if(
      measurements_.begin(), measurements_.begin() + static_cast<std::ptrdiff_t>(count_),
      [](const Measurement& m) { return m.is_used; }));
}

}  // namespace cremed
