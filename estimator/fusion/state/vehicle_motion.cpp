// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/vehicle_motion.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// Random walk of the position (m^2/s): at standstill nothing else is uncertain across, and the
/// covariance would be singular.
constexpr double kPositionWalkM2PerS = 1e-8;

/// Decay of an Ornstein-Uhlenbeck process from 1 after dt, and its integral over dt.
struct Decay {
  double left;
  double integral_s;
};

Decay decay(const OrnsteinUhlenbeck& noise, double dt_s) {
  if (dt_s <= 0.0) {
    return {1.0, dt_s};
  }
  const double left = std::exp(-dt_s / noise.time_s);
  return {left, noise.time_s * (1.0 - left)};
}

/// Adds the noise of a rate and its derivative, an Ornstein-Uhlenbeck process.
void add_rate_noise(const OrnsteinUhlenbeck& noise, double dt_s, int rate,
                    MotionStep::Matrix& sum) {
  const double left = std::exp(-std::abs(dt_s) / noise.time_s);
  const double variance = noise.std * noise.std;
  const double cross = std::copysign(variance * noise.time_s * squared(1.0 - left), dt_s);
  sum(rate, rate) += rate_variance(noise, dt_s);
  sum(rate, rate + 1) += cross;
  sum(rate + 1, rate) += cross;
  sum(rate + 1, rate + 1) += variance * (1.0 - left * left);
}

/// Moves the pose by the noise of the rates within the step. White noise drives the acceleration:
/// given the rate's noise at the end of a short step, its expected mean over the step is 3/8 of it.
void add_pose_noise(MotionStep& step) {
  constexpr double kMeanShare = 3.0 / 8.0;
  auto by_noise = MotionStep::Matrix::Identity().eval();
  for (const int rate : {kSpeed, kYawRate}) {
    by_noise.col(rate).head<kPose>() = kMeanShare * step.jacobian.col(rate).head<kPose>();
  }
  step.noise = (by_noise * step.noise * by_noise.transpose()).eval();
}

void move_pose(const MotionStep::Vector& state, double dt_s, const Decay& a, const Decay& c,
               MotionStep& step) {
  const double v = state(kSpeed) + 0.5 * a.integral_s * state(kAcceleration);
  const double w = state(kYawRate) + 0.5 * c.integral_s * state(kYawAcceleration);
  const double yaw = state(kYaw) + 0.5 * dt_s * w;
  const double k = state(kSlipPerAcceleration);
  const double s = state(kSlip) - k * v * w;
  const Eigen::Vector2d along(std::cos(yaw) - s * std::sin(yaw), std::sin(yaw) + s * std::cos(yaw));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d by_yaw = dt_s * v * across;
  step.state.head<2>() += dt_s * v * along;
  step.state(kYaw) += dt_s * w;
  step.noise(kX, kX) = step.noise(kY, kY) = kPositionWalkM2PerS * std::abs(dt_s);
  auto xy = step.jacobian.topRows<2>();
  const Eigen::Vector2d by_slip = dt_s * v * Eigen::Vector2d(-std::sin(yaw), std::cos(yaw));
  xy.col(kYaw) += by_yaw;
  xy.col(kSpeed) = dt_s * along - k * w * by_slip;
  xy.col(kAcceleration) = 0.5 * a.integral_s * xy.col(kSpeed);
  xy.col(kYawRate) = 0.5 * dt_s * by_yaw - k * v * by_slip;
  xy.col(kYawAcceleration) = 0.5 * c.integral_s * xy.col(kYawRate);
  xy.col(kSlip) = by_slip;
  xy.col(kSlipPerAcceleration) = -v * w * by_slip;
  step.jacobian(kYaw, kYawRate) = dt_s;
  step.jacobian(kYaw, kYawAcceleration) = 0.5 * dt_s * c.integral_s;
}

void move_rate(int rate, const Decay& decay, MotionStep& step) {
  step.state(rate) += decay.integral_s * step.state(rate + 1);
  step.state(rate + 1) *= decay.left;
  step.jacobian(rate, rate + 1) = decay.integral_s;
  step.jacobian(rate + 1, rate + 1) = decay.left;
}

void move_process(int which, const OrnsteinUhlenbeck& process, double dt_s, MotionStep& step) {
  const double left = std::exp(-std::abs(dt_s) / process.time_s);
  step.state(which) *= left;
  step.jacobian(which, which) = left;
  step.noise(which, which) = process.std * process.std * (1.0 - left * left);
}

}  // namespace

MotionStep moved(const MotionStep::Vector& state, double dt_s, const OdometryOptions& options,
                 double skid_variance) {
  MotionStep step{state, MotionStep::Matrix::Identity(), MotionStep::Matrix::Zero()};
  const Decay a = decay(options.acceleration, dt_s);
  const OrnsteinUhlenbeck yaw_acceleration =
      yaw_acceleration_at(state(kSpeed), options, skid_variance);
  const Decay c = decay(yaw_acceleration, dt_s);
  move_pose(state, dt_s, a, c, step);
  move_rate(kSpeed, a, step);
  move_rate(kYawRate, c, step);
  add_rate_noise(options.acceleration, dt_s, kSpeed, step.noise);
  add_rate_noise(yaw_acceleration, dt_s, kYawRate, step.noise);
  move_process(kSlip, bounded_walk(options.slip_std_rad, options.slip_walk), dt_s, step);
  step.noise(kSlip, kSlip) += skid_noise(skid_variance, dt_s);
  move_process(kBodyVelocity, options.body_velocity, dt_s, step);
  add_pose_noise(step);
  return step;
}

double skid_noise(double skid_variance, double dt_s) {
  return skid_variance * (1.0 - std::exp(-2.0 * std::abs(dt_s) / kSkidS));
}

OrnsteinUhlenbeck yaw_acceleration_at(double speed_mps, const OdometryOptions& options,
                                      double skid_variance) {
  OrnsteinUhlenbeck process = options.yaw_acceleration;
  if (skid_variance > 0.0) {
    return process;
  }
  process.std /= std::sqrt(1.0 + squared(speed_mps * process.std / options.lateral_jerk_std_mps3));
  return process;
}

double rate_variance(const OrnsteinUhlenbeck& derivative, double dt_s) {
  const double steps = std::abs(dt_s) / derivative.time_s;
  const double left = std::exp(-steps);
  return derivative.std * derivative.std * squared(derivative.time_s) *
         (2.0 * steps - 3.0 + 4.0 * left - left * left);
}

double variance_by_product(const Eigen::Ref<const Eigen::Matrix3d>& pose_covariance) {
  return 0.25 * pose_covariance.topLeftCorner<2, 2>().trace() * pose_covariance(kYaw, kYaw);
}

VehicleEstimate VehicleEstimate::predicted(double dt_s, const OdometryOptions& options) const {
  VehicleEstimate result = *this;
  for (double left_s = dt_s; left_s > 0.0; left_s -= kMaxMotionStepS) {
    const MotionStep step =
        moved(result.mean, std::min(left_s, kMaxMotionStepS), options, skid_variance);
    const MotionStep::Matrix moved_covariance = step.jacobian * result.covariance;
    const double before = variance_by_product(result.covariance.topLeftCorner<kPose, kPose>());
    result.covariance = moved_covariance * step.jacobian.transpose() + step.noise;
    const double after = variance_by_product(result.covariance.topLeftCorner<kPose, kPose>());
    result.covariance.diagonal().head<2>().array() += std::max(0.0, after - before);
    result.mean = step.state;
  }
  return result;
}

VehicleEstimate VehicleEstimate::at_origin() const {
  VehicleEstimate result = *this;
  result.mean.head<kPose>().setZero();
  result.covariance.topRows<kPose>().setZero();
  result.covariance.leftCols<kPose>().setZero();
  return result;
}

}  // namespace cremed
