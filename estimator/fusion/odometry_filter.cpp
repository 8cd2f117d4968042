// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/fusion/odometry_filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/fusion/joint_velocity.hpp"
#include "estimator/fusion/pose_chain.hpp"
#include "estimator/fusion/vehicle_motion.hpp"
#include "estimator/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Accelerations are straight lines within so short a step.
constexpr double kMaxStepS = 0.1;
/// Above it the Doppler of a scan tells the speed rather than corrects it.
constexpr double kUnknownSpeedStdMps = 1.0;
/// What a radar said longer ago says nothing of now.
constexpr double kVerdictS = 0.3;
/// Radars agree on a velocity up to this mean square, in standard deviations.
constexpr double kMaxDisagreement = 4.0;

double squared(double value) { return value * value; }

int first_of(std::size_t radar) { return state_layout::radar(static_cast<int>(radar)); }

int keyframe_of(std::size_t radar, std::size_t keyframe) {
  return first_of(radar) + state_layout::keyframe(static_cast<int>(keyframe));
}

/// Part of the forward velocity that a radar sees across its axis, where azimuths tell it.
double across_share(const Pose2& mount) { return squared(std::sin(mount.yaw_rad)); }

}  // namespace

OdometryFilter::OdometryFilter(const OdometryOptions& options,
                               std::span<const OdometryRadar> radars)
    : options_(options), state_(size(static_cast<int>(radars.size()))) {
  for (const OdometryRadar& radar : radars) {
    tracks_.push_back(
        std::make_unique<RadarTrack>(options_, radar.vehicle_from_radar, radar.registration));
  }
}

RadarModel OdometryFilter::model(std::size_t radar) const {
  return {state_, options_, tracks_[radar]->mount(), first_of(radar)};
}

Odometry OdometryFilter::update(std::size_t radar, const TargetSet& targets,
                                std::int64_t stamp_us) {
  if (!has_started_ || seconds_between(time_us_, stamp_us) > options_.max_gap_s) {
    start(stamp_us);
  }
  if (seconds_between(stamp_us, time_us_) <= options_.max_lateness_s &&
      tracks_[radar]->is_in_order(stamp_us) && targets.is_finite()) {
    advance(stamp_us);
    advance_errors(radar, tracks_[radar]->begin(stamp_us));
    if (use_doppler(radar, targets, stamp_us)) {
      use_positions(radar, targets, seconds_between(stamp_us, time_us_));
    }
  }
  Odometry odometry;
  tell(odometry);
  return odometry;
}

void OdometryFilter::start(std::int64_t stamp_us) {
  for (int i = 0; i < state_.size(); ++i) {
    state_.set(i, 0.0, 0.0);
  }
  start_motion(Eigen::Vector2d::Zero(),
               Eigen::Vector2d(squared(options_.start_speed_std_mps),
                               squared(options_.start_yaw_rate_std_radps))
                   .asDiagonal());
  state_.set(kSlip, 0.0, squared(options_.slip_std_rad));
  state_.set(kBodyVelocity, 0.0, squared(options_.body_velocity.std));
  state_.set(kCommonOffset, 0.0, squared(options_.common_offset.std));
  state_.set(kCommonScale, 0.0, squared(options_.common_scale_std));
  state_.set(kCommonYawScale, 0.0, squared(options_.common_yaw_scale_std));
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    start_errors(i);
    tracks_[i]->clear();
  }
  has_started_ = true;
  is_settled_ = false;
  used_scans_ = 0;
  time_us_ = used_us_ = clear_us_ = anchor_us_ = output_us_ = stamp_us;
}

void OdometryFilter::start_motion(const Eigen::Vector2d& value, const Eigen::Matrix2d& covariance) {
  state_.set(kSpeed, value.x(), covariance(0, 0));
  state_.set(kAcceleration, 0.0, squared(options_.acceleration.std));
  state_.set(kYawRate, value.y(), covariance(1, 1));
  state_.set(kYawAcceleration, 0.0, squared(options_.yaw_acceleration.std));
}

void OdometryFilter::start_errors(std::size_t radar) {
  const int first = first_of(radar);
  const double across = across_share(tracks_[radar]->mount());
  state_.set(first + kMountYaw, 0.0,
             squared(options_.mount_yaw_std_rad) +
                 squared(across * options_.mount_yaw_across_std_rad));
  state_.set(first + kDopplerScale, 0.0,
             squared(options_.doppler_scale_std) +
                 squared(across * options_.azimuth_scale_std));
  state_.set(first + kDopplerX, 0.0, squared(options_.doppler_x.std));
  state_.set(first + kDopplerY, 0.0, squared(options_.doppler_y.std));
  state_.set(first + kOffset, 0.0, squared(options_.offset.std));
  state_.set(first + kYawScale, 0.0, squared(options_.yaw_scale_std));
  state_.set(first + kLeverX, 0.0, squared(options_.lever_std_m));
  state_.set(first + kLeverY, 0.0, squared(options_.lever_std_m));
  state_.set(first + kYawPerMetre, 0.0, squared(options_.yaw_per_metre.std));
  state_.set(first + kLateralPerMetre, 0.0, squared(options_.lateral_per_metre.std));
}

void OdometryFilter::advance(std::int64_t stamp_us) {
  double left_s = seconds_between(time_us_, stamp_us);
  while (left_s > 0.0) {
    const double dt_s = std::min(left_s, kMaxStepS);
    const MotionStep step = moved(state_.mean().head<kMotionStates>(), dt_s, options_);
    state_.transform<kMotionStates>(step.state, step.jacobian, step.noise);
    const double left = std::exp(-dt_s / options_.common_offset.time_s);
    const double std = options_.common_offset.std +
                       options_.common_offset_per_yaw_rate_m * std::abs(state_.mean(kYawRate));
    state_.forget(kCommonOffset, left, squared(std) * (1.0 - left * left));
    left_s -= dt_s;
  }
  time_us_ = std::max(time_us_, stamp_us);
}

/// A radar's scans come in order: its errors are those of its last scan's time.
void OdometryFilter::advance_errors(std::size_t radar, double dt_s) {
  const int first = first_of(radar);
  const double turning = std::abs(state_.mean(kYawRate));
  const double across_mps = across_share(tracks_[radar]->mount()) * std::abs(state_.mean(kSpeed));
  const auto forget = [&](int which, const ForgettingNoise& noise, double more) {
    const double left = std::exp(-dt_s / noise.time_s);
    const double std = noise.std + more;
    state_.forget(first + which, left, squared(std) * (1.0 - left * left));
  };
  forget(kDopplerX, options_.doppler_x, options_.doppler_x_across_share * across_mps);
  forget(kDopplerY, options_.doppler_y, options_.doppler_y_per_yaw_rate_m * turning);
  forget(kOffset, options_.offset,
         options_.offset_per_yaw_rate_m * turning +
             options_.offset_across_mps * across_share(tracks_[radar]->mount()));
  forget(kYawPerMetre, options_.yaw_per_metre, 0.0);
  forget(kLateralPerMetre, options_.lateral_per_metre, 0.0);
  state_.add_variance(first + kMountYaw, squared(options_.mount_yaw_walk) * dt_s);
}

bool OdometryFilter::use_doppler(std::size_t radar, const TargetSet& targets,
                                 std::int64_t stamp_us) {
  const Pose2& mount = tracks_[radar]->mount();
  const bool is_unknown = state_.std(kSpeed) > kUnknownSpeedStdMps;
  std::optional<Eigen::Vector2d> expected;
  if (!is_unknown) {
    expected = Eigen::Vector2d(state_.mean(kSpeed) - state_.mean(kYawRate) * mount.y_m,
                               state_.mean(kYawRate) * mount.x_m);
  }
  const auto scan = tracks_[radar]->velocity(targets, expected);
  if (!scan) {
    return false;
  }
  if (is_unknown) {
    state_.set_mean(kSpeed, scan->velocity.velocity_mps.x());
  }
  return take_doppler(radar, *scan, stamp_us);
}

bool OdometryFilter::take_doppler(std::size_t radar, const ScanVelocity& scan,
                                  std::int64_t stamp_us) {
  RadarTrust& trust = tracks_[radar]->trust;
  LinearMeasurement measurement =
      model(radar).doppler(scan.velocity, seconds_between(stamp_us, time_us_));
  measurement.noise *= trust.doppler_noise.value();
  const double nis = state_.innovate(measurement);
  const bool is_expected = nis <= options_.max_doppler_nis;
  trust.doppler.add(stamp_us, 0.5 * nis);
  trust.judge(stamp_us, scan.velocity, is_expected);
  if (!trust.is_left_out) {
    trust.doppler_noise.add(0.5 * nis);
  }
  if (!is_expected) {
    ask_majority(stamp_us);
    return false;
  }
  if (trust.is_left_out) {
    return false;
  }
  state_.update();
  radars_ |= 1U << radar;
  used_us_ = time_us_;
  clear_us_ = scan.is_clear ? time_us_ : clear_us_;
  ++used_scans_;
  is_settled_ = is_settled_ || is_known();
  return true;
}

int OdometryFilter::count_verdicts(std::int64_t stamp_us, bool agree) const {
  return static_cast<int>(std::count_if(tracks_.begin(), tracks_.end(), [&](const auto& track) {
    const RadarTrust& trust = track->trust;
    return trust.has_verdict && trust.agrees == agree &&
           seconds_between(trust.verdict_us, stamp_us) <= kVerdictS;
  }));
}

/// If most radars contradict and agree with each other, the velocity begins anew with theirs.
void OdometryFilter::ask_majority(std::int64_t stamp_us) {
  const int agreeing = count_verdicts(stamp_us, true);
  JointVelocity joint(options_);
  for (const auto& track : tracks_) {
    const RadarTrust& trust = track->trust;
    const double age_s = seconds_between(trust.verdict_us, stamp_us);
    if (trust.has_verdict && !trust.agrees && age_s <= kVerdictS) {
      joint.add(trust.velocity, track->mount(), age_s);
    }
  }
  if (joint.radars() < 2 || joint.radars() <= agreeing ||
      joint.disagreement() > kMaxDisagreement) {
    return;
  }
  const Eigen::Vector2d wrong(state_.mean(kSpeed), state_.mean(kYawRate));
  const Eigen::Vector2d error = joint.value() - wrong;
  double since_s = 0.0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    RadarTrust& trust = tracks_[i]->trust;
    if (trust.has_verdict && trust.agrees) {
      start_errors(i);
    } else {
      since_s = std::max(since_s, trust.contradictions * 0.1);
      trust.forgive();
    }
  }
  start_motion(joint.value(), joint.covariance());
  // Nobody knows since when the filter was wrong.
  state_.add_variance(kX, squared(error.x() * since_s));
  state_.add_variance(kY, squared(error.x() * since_s));
  state_.add_variance(kYaw, squared(error.y() * since_s));
}

void OdometryFilter::use_positions(std::size_t radar, const TargetSet& targets, double age_s) {
  RadarTrack& track = *tracks_[radar];
  const Eigen::Vector3d pose =
      moved(state_.mean().head<kMotionStates>(), -std::max(age_s, 0.0), options_).state.head<3>();
  std::array<std::optional<RadarTrack::Pair>, kKeyframes> pairs;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (track.can_match(i, targets)) {
      pairs[i] = track.match(i, targets, model(radar).expected_motion(keyframe_of(radar, i), pose));
    }
  }
  clone_scan(radar, age_s);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i]) {
      use_pair(radar, i, *pairs[i]);
    }
  }
  if (const auto keyframe = track.keep(targets)) {
    state_.copy(first_of(radar) + kScan, keyframe_of(radar, *keyframe));
  }
}

void OdometryFilter::clone_scan(std::size_t radar, double age_s) {
  const MotionStep at_scan =
      moved(state_.mean().head<kMotionStates>(), -std::max(age_s, 0.0), options_);
  const Eigen::Vector3d pose = at_scan.state.head<3>();
  state_.clone<kMotionStates>(
      first_of(radar) + kScan, pose, at_scan.jacobian.topRows<3>(),
      options_.scan_noise_share *
          turned_covariance(pose.z(), tracks_[radar]->scan_covariance()));
}

void OdometryFilter::use_pair(std::size_t radar, std::size_t keyframe,
                              const RadarTrack::Pair& pair) {
  RadarTrust& trust = tracks_[radar]->trust;
  LinearMeasurement measurement = model(radar).position(keyframe_of(radar, keyframe),
                                                        first_of(radar) + kScan, pair.motion);
  measurement.noise = trust.position_noise.value() * options_.pair_noise_factor *
                      (options_.pair_noise_start + options_.pair_noise_per_lag * pair.lag) *
                      pair.covariance.bottomRightCorner<2, 2>();
  const double nis = state_.innovate(measurement);
  trust.lateral.add(time_us_, 0.5 * nis);
  trust.yaw.add(time_us_, 0.5 * nis);
  trust.position_noise.add(0.5 * nis);
  if (nis <= options_.max_position_nis) {
    state_.update();
  }
}

void OdometryFilter::renew_anchor() {
  const Eigen::Vector3d anchor = state_.mean().head<kPose>();
  const auto renew = [&](int pose) {
    const Eigen::Vector3d relative = relative_pose(anchor, state_.mean().segment<kPose>(pose));
    const Eigen::Matrix<double, 3, 6> jacobian = relative_pose_jacobian(anchor, relative);
    state_.transform_pose(pose, relative, jacobian.rightCols<3>(), jacobian.leftCols<3>());
  };
  renew(kOutput);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    renew(first_of(i) + kScan);
    for (std::size_t k = 0; k < kKeyframes; ++k) {
      renew(keyframe_of(i, k));
    }
  }
  for (int i = 0; i < kPose; ++i) {
    state_.set(i, 0.0, 0.0);
  }
  anchor_us_ = time_us_;
}

bool OdometryFilter::is_known() const {
  return state_.std(kSpeed) <= options_.settled_speed_std_mps &&
         state_.std(kYawRate) <= options_.settled_yaw_rate_std_radps &&
         used_scans_ >= options_.settled_scans &&
         count_verdicts(time_us_, true) > count_verdicts(time_us_, false);
}

OdometryStatus OdometryFilter::status() const {
  const double unused_s = seconds_between(used_us_, time_us_);
  if (unused_s > options_.lost_s) {
    return OdometryStatus::lost;
  }
  if (!is_settled_) {
    return count_verdicts(time_us_, false) > 0 ? OdometryStatus::ambiguous
                                               : OdometryStatus::initialising;
  }
  if (unused_s > options_.predicted_s) {
    return OdometryStatus::predicted;
  }
  if (seconds_between(clear_us_, time_us_) > options_.ambiguous_s) {
    return OdometryStatus::ambiguous;
  }
  const bool stands = std::abs(state_.mean(kSpeed)) <= options_.standstill_mps &&
                      state_.std(kSpeed) <= options_.standstill_mps &&
                      std::abs(state_.mean(kYawRate)) <= 3.0 * state_.std(kYawRate);
  return stands ? OdometryStatus::standing_still : OdometryStatus::ok;
}

void OdometryFilter::tell(Odometry& odometry) {
  odometry.utime_us = time_us_;
  odometry.utime_anchor_us = anchor_us_;
  odometry.status = status();
  odometry.pose = state_.mean().head<kPose>();
  odometry.covariance = state_.covariance().topLeftCorner<kPose, kPose>();
  odometry.odom_covariance =
      composed_covariance(anchor_pose_, odom_covariance_, odometry.pose, odometry.covariance);
  const double v = state_.mean(kSpeed);
  const double slip = state_.mean(kSlip);
  Eigen::Matrix3d by_state;
  by_state << 1.0, 0.0, 0.0, slip, 0.0, v, 0.0, 1.0, 0.0;
  constexpr std::array<int, 3> kTwist{kSpeed, kYawRate, kSlip};
  const Eigen::Matrix3d covariance = state_.covariance()(kTwist, kTwist);
  odometry.twist = {v, slip * v, state_.mean(kYawRate)};
  odometry.twist_covariance = by_state * covariance * by_state.transpose();
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    odometry.left_out |= tracks_[i]->trust.is_left_out ? 1U << i : 0U;
  }
  odometry.is_new = time_us_ > output_us_;
  if (odometry.is_new) {
    tell_motion(odometry);
  }
  odometry.odom_pose = odom_pose_;
}

void OdometryFilter::tell_motion(Odometry& odometry) {
  const Eigen::Vector3d before = state_.mean().segment<kPose>(kOutput);
  constexpr std::array<int, 6> kPoses{kOutput, kOutput + 1, kOutput + 2, kX, kY, kYaw};
  odometry.utime_before_us = output_us_;
  odometry.motion = relative_pose(before, odometry.pose);
  const auto jacobian = relative_pose_jacobian(before, odometry.motion);
  const Eigen::Matrix<double, 6, 6> covariance = state_.covariance()(kPoses, kPoses);
  odometry.motion_covariance = jacobian * covariance * jacobian.transpose();
  odometry.radars = radars_;
  odom_pose_ = composed_pose(odom_pose_, odometry.motion);
  output_us_ = time_us_;
  radars_ = 0;
  state_.copy(kX, kOutput);
  if (seconds_between(anchor_us_, time_us_) >= options_.anchor_period_s) {
    odom_covariance_ = odometry.odom_covariance;
    anchor_pose_ = composed_pose(anchor_pose_, odometry.pose);
    renew_anchor();
  }
}

RadarReport OdometryFilter::report(std::size_t radar) const {
  const RadarTrust& trust = tracks_[radar]->trust;
  const int first = first_of(radar);
  return {trust.is_left_out,
          trust.doppler.mean(),
          trust.lateral.mean(),
          trust.yaw.mean(),
          trust.doppler_noise.value(),
          trust.position_noise.value(),
          state_.mean(first + kMountYaw),
          state_.std(first + kMountYaw),
          state_.mean(first + kDopplerScale),
          state_.std(first + kDopplerScale)};
}

}  // namespace cremed
