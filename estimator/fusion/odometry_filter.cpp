// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/fusion/odometry_filter.hpp"

#include <algorithm>
#include <cmath>

#include "estimator/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

constexpr double kMaxStepS = 0.1;

double squared(double value) { return value * value; }

RegistrationOptions positions_only(RegistrationOptions options) {
  options.degrees_of_freedom = 3;
  options.start_scale = 1.0;
  options.doppler.enabled = false;
  options.covariance = CovarianceModel::exclusive;
  options.shared_errors = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  return options;
}

}  // namespace

OdometryFilter::OdometryFilter(const OdometryOptions& options,
                               std::span<const OdometryRadar> radars)
    : options_(options), state_(size(static_cast<int>(radars.size()))) {
  for (const OdometryRadar& radar : radars) {
    tracks_.push_back(std::make_unique<RadarTrack>(positions_only(radar.registration),
                                                   radar.vehicle_from_radar));
  }
}

RadarModel OdometryFilter::model(std::size_t radar) const {
  return {state_, options_, tracks_[radar]->vehicle_from_radar,
          state_layout::radar(static_cast<int>(radar))};
}

Odometry OdometryFilter::update(std::size_t radar, const TargetSet& targets,
                                std::int64_t stamp_us) {
  Odometry odometry;
  debug = {};
  if (!has_started_ || seconds_between(time_us_, stamp_us) > options_.max_gap_s) {
    start(stamp_us);
  }
  RadarTrack& track = *tracks_[radar];
  const double lateness_s = seconds_between(stamp_us, time_us_);
  if (lateness_s > options_.max_lateness_s || (track.has_stamp && stamp_us <= track.stamp_us)) {
    finish(odometry);
    return odometry;
  }
  advance(stamp_us);
  forget_errors(radar, stamp_us);
  const double age_s = seconds_between(stamp_us, time_us_);
  use_doppler(radar, targets, age_s);
  use_positions(radar, targets, age_s);
  finish(odometry);
  return odometry;
}

void OdometryFilter::start(std::int64_t stamp_us) {
  for (int i = 0; i < state_.size(); ++i) {
    state_.set(i, 0.0, 0.0);
  }
  state_.set(kSpeed, 0.0, squared(options_.start_speed_std_mps));
  state_.set(kAcceleration, 0.0, squared(options_.acceleration.std));
  state_.set(kYawRate, 0.0, squared(options_.start_yaw_rate_std_radps));
  state_.set(kYawAcceleration, 0.0, squared(options_.yaw_acceleration.std));
  state_.set(kSlip, 0.0, squared(options_.slip_std_rad));
  state_.set(kBodyVelocity, 0.0, squared(options_.body_velocity.std));
  state_.set(kCommonOffset, 0.0, squared(options_.common_offset.std));
  state_.set(kCommonYawScale, 0.0, squared(options_.common_yaw_scale_std));
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    RadarTrack& track = *tracks_[i];
    const int first = state_layout::radar(static_cast<int>(i));
    state_.set(first + kMountYaw, 0.0, squared(options_.mount_yaw_std_rad));
    state_.set(first + kDopplerScale, 0.0, squared(options_.doppler_scale_std));
    state_.set(first + kDopplerX, 0.0, squared(options_.doppler_x.std));
    state_.set(first + kDopplerY, 0.0, squared(options_.doppler_y.std));
    state_.set(first + kOffset, 0.0, squared(options_.offset.std));
    state_.set(first + kYawScale, 0.0, squared(options_.yaw_scale_std));
    state_.set(first + kYawPerMetre, 0.0, squared(options_.yaw_per_metre.std));
    state_.set(first + kLateralPerMetre, 0.0, squared(options_.lateral_per_metre.std));
    for (RadarTrack::Keyframe& keyframe : track.keyframes) {
      keyframe.is_set = false;
    }
    track.has_stamp = false;
    track.doppler_std_mps = options_.doppler_std_mps;
    track.scan_covariance = Eigen::Vector3d(0.1 * 0.1, 0.1 * 0.1, 0.005 * 0.005).asDiagonal();
  }
  has_started_ = true;
  time_us_ = stamp_us;
  anchor_us_ = stamp_us;
  output_us_ = stamp_us;
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

void OdometryFilter::forget_errors(std::size_t radar, std::int64_t stamp_us) {
  RadarTrack& track = *tracks_[radar];
  const double dt_s = track.has_stamp ? seconds_between(track.stamp_us, stamp_us) : 0.0;
  track.stamp_us = stamp_us;
  track.has_stamp = true;
  const int first = state_layout::radar(static_cast<int>(radar));
  const double turning = std::abs(state_.mean(kYawRate));
  const auto forget = [&](int which, const ForgettingNoise& noise, double more) {
    const double left = std::exp(-dt_s / noise.time_s);
    state_.forget(first + which, left, squared(noise.std + more * turning) * (1.0 - left * left));
  };
  forget(kDopplerX, options_.doppler_x, 0.0);
  forget(kDopplerY, options_.doppler_y, options_.doppler_y_per_yaw_rate_m);
  forget(kOffset, options_.offset, options_.offset_per_yaw_rate_m);
  forget(kYawPerMetre, options_.yaw_per_metre, 0.0);
  forget(kLateralPerMetre, options_.lateral_per_metre, 0.0);
  state_.add_variance(first + kMountYaw, squared(options_.mount_yaw_walk) * dt_s);
}

void OdometryFilter::use_doppler(std::size_t radar, const TargetSet& targets, double age_s) {
  RadarTrack& track = *tracks_[radar];
  const Pose2& mount = track.vehicle_from_radar;
  const bool is_unknown = state_.std(kSpeed) > 1.0;
  const Eigen::Vector2d start =
      is_unknown ? DopplerVelocityEstimator::search(targets)
                 : Eigen::Vector2d(state_.mean(kSpeed) - state_.mean(kYawRate) * mount.y_m,
                                   state_.mean(kYawRate) * mount.x_m);
  const auto velocity = track.doppler.fit(targets, start, track.doppler_std_mps);
  if (!velocity) {
    return;
  }
  const double share = std::min(0.1, velocity->targets / 500.0);
  const double variance = squared(std::clamp(velocity->residual_std_mps, 0.05, 0.6));
  track.doppler_std_mps =
      std::sqrt((1.0 - share) * squared(track.doppler_std_mps) + share * variance);
  if (is_unknown) {
    state_.set_mean(kSpeed, velocity->velocity_mps.x());
  }
  const LinearMeasurement measurement = model(radar).doppler(*velocity, age_s);
  debug.doppler_nis = state_.innovate(measurement);
  debug.v[0] = velocity->velocity_mps.x();
  debug.v[1] = velocity->velocity_mps.y();
  debug.dres[0] = measurement.residual.x();
  debug.dres[1] = measurement.residual.y();
  debug.std = track.doppler_std_mps;
  debug.used = velocity->targets;
  if (debug.doppler_nis <= options_.max_doppler_nis) {
    state_.update();
    radars_ |= 1U << radar;
  }
}

void OdometryFilter::use_positions(std::size_t radar, const TargetSet& targets, double age_s) {
  RadarTrack& track = *tracks_[radar];
  const int first = state_layout::radar(static_cast<int>(radar));
  const MotionStep at_stamp =
      moved(state_.mean().head<kMotionStates>(), -std::max(age_s, 0.0), options_);
  const Eigen::Vector3d pose = at_stamp.state.head<3>();
  pair_count_ = 0;
  for (std::size_t i = 0; i < track.keyframes.size(); ++i) {
    RadarTrack::Keyframe& keyframe = track.keyframes[i];
    ++keyframe.lag;
    if (!keyframe.is_set || keyframe.lag < options_.min_lag || targets.size() < 5) {
      continue;
    }
    const std::array<Eigen::Vector3d, 1> start{
        model(radar).expected_motion(first + state_layout::keyframe(static_cast<int>(i)), pose)};
    track.registration.set_previous(keyframe.targets);
    const RegistrationResult result = track.registration.solve(targets, 1.0, start);
    const double share =
        result.matched / static_cast<double>(std::min(targets.size(), keyframe.targets.size()));
    if (result.status == RegistrationStatus::converged && share >= options_.min_matched_share) {
      pairs_[pair_count_++] = {i, result.motion, result.covariance};
    }
  }
  if (pair_count_ > 0) {
    track.scan_covariance = pairs_[0].covariance;
  }
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << std::cos(pose.z()), -std::sin(pose.z()), std::sin(pose.z()),
      std::cos(pose.z());
  const Eigen::Matrix3d noise =
      options_.scan_noise_share * turn * track.scan_covariance * turn.transpose();
  state_.clone<kMotionStates>(first + kScan, pose, at_stamp.jacobian.topRows<3>(), noise);
  for (std::size_t k = 0; k < pair_count_; ++k) {
    const Pair& pair = pairs_[k];
    const int lag = track.keyframes[pair.keyframe].lag;
    LinearMeasurement measurement = model(radar).position(
        first + state_layout::keyframe(static_cast<int>(pair.keyframe)), first + kScan,
        pair.motion);
    measurement.noise = options_.pair_noise_factor *
                        (options_.pair_noise_start + options_.pair_noise_per_lag * lag) *
                        pair.covariance.bottomRightCorner<2, 2>();
    const double nis = state_.innovate(measurement);
    debug.nis[k] = nis;
    debug.lag[k] = lag;
    debug.pairs = static_cast<int>(k) + 1;
    if (nis <= options_.max_position_nis) {
      state_.update();
      radars_ |= 1U << radar;
    }
  }
  // The oldest makes room.
  auto oldest = track.keyframes.begin();
  int youngest_lag = 1 << 30;
  for (auto keyframe = track.keyframes.begin(); keyframe != track.keyframes.end(); ++keyframe) {
    if (!keyframe->is_set) {
      keyframe->lag = 1 << 20;
    }
    youngest_lag = std::min(youngest_lag, keyframe->lag);
    if (keyframe->lag > oldest->lag) {
      oldest = keyframe;
    }
  }
  if (youngest_lag >= options_.keyframe_period && targets.size() >= 5) {
    oldest->is_set = true;
    oldest->lag = 0;
    oldest->targets = targets;
    state_.copy(first + kScan, first + state_layout::keyframe(static_cast<int>(
                                           oldest - track.keyframes.begin())));
  }
}

void OdometryFilter::renew_anchor() {
  const Eigen::Vector3d anchor = state_.mean().head<3>();
  const auto renew = [&](int to) {
    const Eigen::Vector3d relative = relative_pose(anchor, state_.mean().segment<3>(to));
    const double c = std::cos(anchor.z());
    const double s = std::sin(anchor.z());
    Eigen::Matrix3d by_self;
    by_self << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
    Eigen::Matrix3d by_first = -by_self;
    by_first.col(2) = Eigen::Vector3d(relative.y(), -relative.x(), -1.0);
    state_.transform_pose(to, relative, by_self, by_first);
  };
  renew(kOutput);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const int first = state_layout::radar(static_cast<int>(i));
    renew(first + kScan);
    for (int k = 0; k < kKeyframes; ++k) {
      renew(first + state_layout::keyframe(k));
    }
  }
  for (int i = 0; i < kPose; ++i) {
    state_.set(i, 0.0, 0.0);
  }
  anchor_us_ = time_us_;
}

void OdometryFilter::finish(Odometry& odometry) {
  odometry.utime_us = time_us_;
  odometry.utime_anchor_us = anchor_us_;
  odometry.is_new = time_us_ > output_us_;
  odometry.pose = state_.mean().head<3>();
  odometry.covariance = state_.covariance().topLeftCorner<3, 3>();
  const double v = state_.mean(kSpeed);
  const double s = state_.mean(kSlip);
  Eigen::Matrix3d by = Eigen::Matrix3d::Zero();
  by(0, 0) = 1.0;
  by(1, 0) = s;
  by(1, 2) = v;
  by(2, 1) = 1.0;
  const std::array<int, 3> which{kSpeed, kYawRate, kSlip};
  odometry.twist = {v, s * v, state_.mean(kYawRate)};
  odometry.twist_covariance =
      by * state_.covariance()(which, which).eval() * by.transpose();
  if (odometry.is_new) {
    const Eigen::Vector3d before = state_.mean().segment<3>(kOutput);
    odometry.utime_before_us = output_us_;
    odometry.motion = relative_pose(before, odometry.pose);
    const double c = std::cos(before.z());
    const double n = std::sin(before.z());
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << c, n, 0, -c, -n, odometry.motion.y(),  //
        -n, c, 0, n, -c, -odometry.motion.x(),         //
        0, 0, 1, 0, 0, -1;
    const std::array<int, 6> poses{0, 1, 2, kOutput, kOutput + 1, kOutput + 2};
    odometry.motion_covariance =
        jacobian * state_.covariance()(poses, poses).eval() * jacobian.transpose();
    odom_pose_ = composed_pose(odom_pose_, odometry.motion);
    odometry.radars = radars_;
    radars_ = 0;
    output_us_ = time_us_;
    state_.copy(0, kOutput);
    if (seconds_between(anchor_us_, time_us_) >= options_.anchor_period_s) {
      renew_anchor();
    }
  }
  odometry.odom_pose = odom_pose_;
}

}  // namespace cremed
