// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/odometry_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

int size_of(std::size_t radars, const OdometryOptions& options) {
  return size(static_cast<int>(radars)) + (options.vehicle.is_used() ? kVehicleStates : 0);
}

int first_of(std::size_t radar) { return state_layout::radar(static_cast<int>(radar)); }

/// Part of the forward velocity across a radar's axis, where it is measured by azimuths.
double across_share(const Pose2& mount) { return squared(std::sin(mount.yaw_rad)); }

/// Propagates an Ornstein-Uhlenbeck process by dt, with a standard deviation larger by `more`.
void forget(GaussianState& state, int which, const OrnsteinUhlenbeck& noise, double more,
            double dt_s) {
  const double left = std::exp(-dt_s / noise.time_s);
  state.forget(which, left, squared(noise.std + more) * (1.0 - left * left));
}

std::vector<LearnedError> unlearned_of(const OdometryOptions& options,
                                       const std::vector<Pose2>& mounts,
                                       LearnedError LearnedErrors::*which) {
  std::vector<LearnedError> unlearned;
  unlearned.reserve(mounts.size());
  for (const Pose2& mount : mounts) {
    unlearned.push_back(unlearned_errors(options, mount).*which);
  }
  return unlearned;
}

SharedPrior prior_of(const OdometryOptions& options, const std::vector<Pose2>& mounts,
                     const std::vector<std::optional<LearnedErrors>>& learned,
                     LearnedError LearnedErrors::*which, double restart_std) {
  std::vector<std::optional<LearnedError>> errors(mounts.size());
  for (std::size_t i = 0; i < mounts.size(); ++i) {
    if (i < learned.size() && learned[i]) {
      errors[i] = (*learned[i]).*which;
    }
  }
  return prior_after(errors, unlearned_of(options, mounts, which), restart_std);
}

}  // namespace

OdometryState::OdometryState(const OdometryOptions& options, std::vector<Pose2> mounts,
                             const std::vector<std::optional<LearnedErrors>>& learned)
    : gaussian(size_of(mounts.size(), options)),
      options_(options),
      mounts_(std::move(mounts)),
      has_forward_radar_(!std::all_of(mounts_.begin(), mounts_.end(), looks_across)),
      mount_yaw_(prior_of(options, mounts_, learned, &LearnedErrors::mount_yaw_rad,
                          options.mount_yaw_restart_std_rad)),
      doppler_scale_(prior_of(options, mounts_, learned, &LearnedErrors::doppler_scale,
                              options.doppler_scale_restart_std)),
      considered_{{kCommonAzimuthScale}, {kCommonYawPerMetre}, {kSlipPerAcceleration}} {
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    for (const int which : {kAzimuthScale, kLeverX, kLeverY}) {
      considered_.push_back({error(i, which)});
    }
  }
  considered_but_by_x_ = considered_;
  const auto consider_but_by_x = [&](int scale) {
    considered_.push_back({scale});
    considered_but_by_x_.push_back({scale, 1});
  };
  consider_but_by_x(kCommonScale);
  if (mounts_.size() == 1) {
    consider_but_by_x(error(0, kDopplerScale));
  }
  if (options.vehicle.is_used()) {
    considered_but_by_x_.push_back({vehicle_error(kYawRateGain)});
  }
  considered_at_rest_ = considered_;
  // A single radar's are not separable from slip and speed, and not learned.
  for (std::size_t i = 0; mounts_.size() > 1 && i < mounts_.size(); ++i) {
    considered_at_rest_.push_back({error(i, kMountYaw)});
    considered_at_rest_.push_back({error(i, kDopplerScale)});
  }
}

void OdometryState::update(const Innovation& innovation, bool is_of_positions) {
  const bool is_at_rest = std::abs(gaussian.mean(kSpeed)) < options_.standstill_mps;
  const ConsideredStates& driving = is_of_positions ? considered_but_by_x_ : considered_;
  gaussian.update(innovation, is_at_rest ? considered_at_rest_ : driving);
}

void OdometryState::start(std::int64_t time_us) {
  for (int i = 0; i < gaussian.size(); ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
  gaussian.set(kSlip, 0.0, squared(options_.slip_std_rad));
  gaussian.set(kSlipPerAcceleration, options_.slip_per_lateral_acceleration,
               squared(options_.slip_per_lateral_acceleration_std));
  gaussian.set(kCommonScale, 0.0, squared(options_.common_scale_std));
  gaussian.set(kCommonAzimuthScale, 0.0, squared(options_.common_azimuth_scale_std));
  gaussian.set(kCommonYawPerMetre, 0.0, squared(options_.common_yaw_per_metre_std));
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    for (const int which : {kAzimuthScale, kLeverX, kLeverY}) {
      gaussian.set(error(i, which), 0.0, squared(prior_std(i, which)));
    }
  }
  start_shared(kMountYaw, mount_yaw_);
  start_shared(kDopplerScale, doppler_scale_);
  if (options_.vehicle.is_used()) {
    start_signal(VehicleSignal::speed);
    start_signal(VehicleSignal::yaw_rate);
  }
  restart(time_us);
}

void OdometryState::restart(std::int64_t time_us) {
  time_us_ = time_us;
  for (int i = 0; i < kPose; ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
  for (int i = kOutput; i < kFirstRadar; ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
  start_motion(Eigen::Vector2d::Zero(), Eigen::Vector2d(squared(options_.start_speed_std_mps),
                                                        squared(options_.start_yaw_rate_std_radps))
                                            .asDiagonal());
  gaussian.set(kBodyVelocity, 0.0, squared(options_.body_velocity.std));
  gaussian.set(kCommonOffset, 0.0, squared(options_.common_offset.std));
  for (std::size_t i = 0; i < mounts_.size(); ++i) {
    start_passing(i);
  }
}

void OdometryState::start_shared(int which, const SharedPrior& prior) {
  for (std::size_t i = 0; i < prior.own.size(); ++i) {
    gaussian.set(error(i, which), prior.own[i].value, squared(prior.own[i].std));
  }
  for (std::size_t i = 0; i < prior.own.size(); ++i) {
    for (std::size_t j = 0; j < prior.own.size(); ++j) {
      if (prior.own[i].is_learned && prior.own[j].is_learned) {
        gaussian.add_covariance(error(i, which), error(j, which), prior.common_variance);
      }
    }
  }
}

void OdometryState::start_motion(const Eigen::Vector2d& value, const Eigen::Matrix2d& covariance) {
  gaussian.set(kSpeed, value.x(), covariance(0, 0));
  gaussian.set(kAcceleration, 0.0, squared(options_.acceleration.std));
  gaussian.set(kYawRate, value.y(), covariance(1, 1));
  gaussian.set(kYawAcceleration, 0.0, squared(options_.yaw_acceleration.std));
  gaussian.add_covariance(kSpeed, kYawRate, covariance(0, 1));
  gaussian.add_covariance(kYawRate, kSpeed, covariance(1, 0));
}

/// Of an error that lasts for the whole drive.
double OdometryState::prior_std(std::size_t radar, int lasting_error) const {
  switch (lasting_error) {
    case kMountYaw:
      return unlearned_errors(options_, mounts_[radar]).mount_yaw_rad.std;
    case kDopplerScale:
      return unlearned_errors(options_, mounts_[radar]).doppler_scale.std;
    case kAzimuthScale:
      return options_.position_azimuth_scale_std;
    default:
      return options_.lever_std_m;
  }
}

void OdometryState::widen_errors(std::size_t radar) {
  for (const int which : {kMountYaw, kDopplerScale, kLeverX, kLeverY}) {
    const int i = error(radar, which);
    gaussian.set(i, gaussian.mean(i), squared(prior_std(radar, which)));
  }
  start_passing(radar);
}

/// Resets the errors of a radar that pass within seconds.
void OdometryState::start_passing(std::size_t radar) {
  const double across = across_share(mounts_[radar]);
  const auto set = [&](int which, double std, double more = 0.0) {
    gaussian.set(error(radar, which), 0.0, squared(std + more));
  };
  set(kDopplerX, options_.doppler_x.std);
  set(kDopplerY, options_.doppler_y.std);
  set(kOffset, options_.offset.std, across * options_.offset_across_mps);
  set(kYawPerMetre, options_.yaw_per_metre.std);
  set(kLateralPerMetre, options_.lateral_per_metre.std);
}

void OdometryState::advance_to(std::int64_t time_us) {
  for (double left_s = seconds_between(time_us_, time_us); left_s > 0.0;
       left_s -= kMaxMotionStepS) {
    const double step_s = std::min(left_s, kMaxMotionStepS);
    const MotionStep step = moved(gaussian.mean().head<kMotionStates>(), step_s, options_);
    gaussian.transform<kMotionStates>(step.state, step.jacobian, step.noise);
    const double turning = std::abs(gaussian.mean(kYawRate));
    forget(gaussian, kCommonOffset, options_.common_offset,
           options_.common_offset_per_yaw_rate_m * turning, step_s);
  }
  time_us_ = std::max(time_us_, time_us);
}

VehicleEstimate OdometryState::vehicle() const {
  return {gaussian.mean().head<kMotionStates>(),
          gaussian.covariance().topLeftCorner<kMotionStates, kMotionStates>()};
}

void OdometryState::advance_errors(std::size_t radar, double dt_s) {
  const int first = first_of(radar);
  const double turning = std::abs(gaussian.mean(kYawRate));
  const double across = across_share(mounts_[radar]);
  const double across_mps = across * std::abs(gaussian.mean(kSpeed));
  forget(gaussian, first + kDopplerX, options_.doppler_x,
         options_.doppler_x_across_share * across_mps, dt_s);
  forget(gaussian, first + kDopplerY, options_.doppler_y,
         options_.doppler_y_per_yaw_rate_m * turning, dt_s);
  forget(gaussian, first + kOffset, options_.offset,
         options_.offset_per_yaw_rate_m * turning + options_.offset_across_mps * across, dt_s);
  forget(gaussian, first + kYawPerMetre, options_.yaw_per_metre, 0.0, dt_s);
  forget(gaussian, first + kLateralPerMetre, options_.lateral_per_metre, 0.0, dt_s);
  forget(gaussian, first + kDopplerScale,
         {prior_std(radar, kDopplerScale), options_.doppler_scale_time_s}, 0.0, dt_s);
  // At rest nothing turns the mount, and nothing observes it.
  const double driving = std::min(1.0, std::abs(gaussian.mean(kSpeed)) / kDrivingMps);
  forget(gaussian, first + kMountYaw,
         bounded_walk(prior_std(radar, kMountYaw), options_.mount_yaw_walk), 0.0, driving * dt_s);
}

void OdometryState::start_signal(VehicleSignal signal) {
  const VehicleOptions& options = options_.vehicle;
  const double scale_variance = squared(options.of(signal).scale_std);
  if (signal == VehicleSignal::speed) {
    gaussian.set(vehicle_error(kSpeedScale), 0.0, scale_variance);
  } else {
    gaussian.set(vehicle_error(kYawRateGain), 0.0, scale_variance);
    gaussian.set(vehicle_error(kYawRateBias), 0.0, squared(options.yaw_rate_bias_std_radps));
  }
}

void OdometryState::advance_signal(VehicleSignal signal, double dt_s) {
  const VehicleOptions& options = options_.vehicle;
  const OrnsteinUhlenbeck scale{options.of(signal).scale_std, options.scale_time_s};
  if (signal == VehicleSignal::speed) {
    forget(gaussian, vehicle_error(kSpeedScale), scale, 0.0, dt_s);
  } else {
    forget(gaussian, vehicle_error(kYawRateGain), scale, 0.0, dt_s);
    gaussian.add_variance(vehicle_error(kYawRateBias), squared(options.yaw_rate_bias_walk) * dt_s);
  }
}

Eigen::Vector2d OdometryState::radar_velocity(std::size_t radar) const {
  const double w = gaussian.mean(kYawRate);
  return {gaussian.mean(kSpeed) - w * mounts_[radar].y_m, w * mounts_[radar].x_m};
}

Eigen::Vector3d OdometryState::pose_before(double age_s) const {
  return moved(gaussian.mean().head<kMotionStates>(), -age_s, options_).state.head<kPose>();
}

Eigen::Vector3d OdometryState::pose_before(double age_s, PoseJacobian& jacobian) const {
  const MotionStep step = moved(gaussian.mean().head<kMotionStates>(), -age_s, options_);
  jacobian = step.jacobian.topRows<kPose>();
  return step.state.head<kPose>();
}

void OdometryState::clone_node(std::size_t node, double age_s) {
  PoseJacobian jacobian;
  const Eigen::Vector3d pose = pose_before(age_s, jacobian);
  gaussian.clone<kMotionStates>(state_layout::node(node), pose, jacobian, Eigen::Matrix3d::Zero());
}

Eigen::Vector3d OdometryState::node_pose(std::size_t node) const {
  return gaussian.mean().segment<kPose>(state_layout::node(node));
}

void OdometryState::clone_output() { gaussian.copy(kX, kOutput); }

void OdometryState::renew_anchor() {
  const Eigen::Vector3d anchor = gaussian.mean().head<kPose>();
  const auto renew = [&](int pose) {
    const Eigen::Vector3d relative = relative_pose(anchor, gaussian.mean().segment<kPose>(pose));
    const Eigen::Matrix<double, 3, 6> jacobian = relative_pose_jacobian(anchor, relative);
    gaussian.transform_pose(pose, relative, jacobian.rightCols<3>(), jacobian.leftCols<3>());
  };
  renew(kOutput);
  for (std::size_t i = 0; i < kNodes; ++i) {
    renew(node(i));
  }
  for (int i = 0; i < kPose; ++i) {
    gaussian.set(i, 0.0, 0.0);
  }
}

std::vector<LearnedErrors> OdometryState::learned() const {
  const auto differences_of = [&](int which, LearnedError LearnedErrors::*error) {
    std::vector<int> states;
    for (std::size_t i = 0; i < mounts_.size(); ++i) {
      states.push_back(this->error(i, which));
    }
    return differences(gaussian.mean()(states), gaussian.covariance()(states, states),
                       unlearned_of(options_, mounts_, error));
  };
  const auto yaws = differences_of(kMountYaw, &LearnedErrors::mount_yaw_rad);
  const auto scales = differences_of(kDopplerScale, &LearnedErrors::doppler_scale);
  std::vector<LearnedErrors> result;
  for (std::size_t i = 0; i < std::min(yaws.size(), scales.size()); ++i) {
    result.push_back({yaws[i], scales[i]});
  }
  return result;
}

int OdometryState::error(std::size_t radar, int which) const { return first_of(radar) + which; }

int OdometryState::vehicle_error(int which) const { return first_of(mounts_.size()) + which; }

}  // namespace cremed
