// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/output/odometry_output.hpp"

#include <algorithm>
#include <array>

#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "cremed/estimator/scan/stamps.hpp"

namespace cremed {
namespace {

using namespace state_layout;

/// In a gap the pose goes on for so long. The turn is then as uncertain as with nothing known.
constexpr double kMaxBlindS = 5.0;

/// Exactly symmetric, as users may expect.
Eigen::Matrix3d symmetric(const Eigen::Matrix3d& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

/// Adds (v, slip v, yaw rate), the velocity of the rear axle's centre in the vehicle's axes.
void add_twist(const VehicleEstimate& vehicle, Odometry& odometry) {
  const double v = vehicle.mean(kSpeed);
  const double w = vehicle.mean(kYawRate);
  const double k = vehicle.mean(kSlipPerAcceleration);
  const double slip = vehicle.mean(kSlip) - k * v * w;
  Eigen::Matrix<double, 3, 4> by_state;
  by_state << 1.0, 0.0, 0.0, 0.0,  //
      slip - k * v * w, -k * v * v, v, -v * v * w, 0.0, 1.0, 0.0, 0.0;
  constexpr std::array<int, 4> kTwist{kSpeed, kYawRate, kSlip, kSlipPerAcceleration};
  const Eigen::Matrix4d covariance = vehicle.covariance(kTwist, kTwist);
  odometry.twist = {v, slip * v, w};
  odometry.twist_covariance = symmetric(by_state * covariance * by_state.transpose());
  // Of second order: the product of slip and speed, both of which are unknown near standstill.
  odometry.twist_covariance(1, 1) += covariance(0, 0) * covariance(2, 2);
}

}  // namespace

OdometryOutput::OdometryOutput(OdometryState& state) : state_(state) {}

Eigen::Matrix3d OdometryOutput::Anchor::full_covariance(const LastingErrors& lasting) const {
  const Eigen::Vector3d variance(squared(lasting.scale_std), squared(lasting.slip_std_rad),
                                 squared(lasting.yaw_per_metre_std));
  return symmetric(covariance + by_lasting * variance.asDiagonal() * by_lasting.transpose());
}

OdometryOutput::Anchor OdometryOutput::Anchor::moved(std::int64_t at_us,
                                                     const VehicleEstimate& vehicle) const {
  const Eigen::Vector3d motion = vehicle.mean.head<kPose>();
  const auto jacobian = composed_pose_jacobian(pose, motion);
  const Eigen::Matrix3d by_pose = jacobian.leftCols<kPose>();
  const Eigen::Matrix3d by_motion = jacobian.rightCols<kPose>();
  const double x_m = motion.x();
  const double y_m = motion.y();
  Eigen::Matrix3d motion_by_lasting;
  motion_by_lasting << x_m, -y_m, -0.5 * x_m * y_m,  //
      y_m, x_m, 0.5 * x_m * x_m,                     //
      0.0, 0.0, x_m;
  return {at_us, composed_pose(pose, motion),
          symmetric(by_pose * covariance * by_pose.transpose() +
                    by_motion * vehicle.covariance.topLeftCorner<kPose, kPose>() *
                        by_motion.transpose()),
          by_pose * by_lasting + by_motion * motion_by_lasting};
}

void OdometryOutput::restart(std::int64_t time_us, double gap_s, Gap gap) {
  const OdometryOptions& options = state_.options();
  const double blind_s =
      std::clamp(seconds_between(state_.time_us(), time_us), 0.0, std::min(gap_s, kMaxBlindS));
  anchor_ = anchor_.moved(time_us, state_.vehicle().predicted(blind_s, options));
  double way_m = options.start_speed_std_mps * gap_s;
  double turn_rad = options.start_yaw_rate_std_radps * gap_s;
  if (gap == Gap::speed && gap_s <= kMaxBlindS) {
    way_m = std::min(way_m, 0.5 * options.acceleration.std * squared(gap_s));
    turn_rad = std::min(turn_rad, 0.5 * options.yaw_acceleration.std * squared(gap_s));
  }
  anchor_.covariance.diagonal() +=
      Eigen::Vector3d(squared(way_m), squared(way_m), squared(turn_rad));
  anchor_.covariance += drift_covariance_;
  drift_covariance_.setZero();
  odom_pose_ = odom_pose_of(state_.gaussian.mean().segment<kPose>(kX));
  if (gap_s > 0.0) {
    odom_pose_ = predicted_odom_pose(time_us);
  }
  anchor_.pose = odom_pose_;
  anchor_.utime_us = output_us_ = time_us;
  next_anchor_us_.reset();
  is_anchor_over_ = false;
  predicted_us_ = std::max(predicted_us_, time_us);
  state_.restart(time_us);
}

/// A pose of the state's frame as a pose since the start: of the last output, and the way since.
Eigen::Vector3d OdometryOutput::odom_pose_of(const Eigen::Vector3d& pose) const {
  return composed_pose(odom_pose_,
                       relative_pose(state_.gaussian.mean().segment<kPose>(kOutput), pose));
}

/// Pose since the start at a time, or kMaxBlindS after the state if that is earlier; not before
/// what was published.
Eigen::Vector3d OdometryOutput::predicted_odom_pose(std::int64_t time_us) const {
  const OdometryOptions& options = state_.options();
  const bool has_prediction = predicted_us_ > state_.time_us();
  const std::int64_t from_us = has_prediction ? predicted_us_ : state_.time_us();
  const double left_s = kMaxBlindS - seconds_between(state_.time_us(), from_us);
  const double blind_s = std::min(seconds_between(from_us, time_us), left_s);
  const VehicleEstimate ahead = state_.vehicle().at_origin().predicted(blind_s, options);
  return composed_pose(has_prediction ? predicted_odom_pose_ : odom_pose_,
                       ahead.mean.head<kPose>());
}

void OdometryOutput::leave_clock() {
  restart(state_.time_us(), state_.options().max_gap_s, Gap::nothing);
  predicted_us_ = std::numeric_limits<std::int64_t>::min();
}

void OdometryOutput::advance_to(std::int64_t stamp_us) {
  if (next_anchor_us_ && *next_anchor_us_ <= stamp_us) {
    state_.advance_to(*next_anchor_us_);
    renew_anchor();
  }
  state_.advance_to(stamp_us);
}

void OdometryOutput::end_anchor() {
  if (state_.options().rate_hz == 0) {
    renew_anchor();
  } else {
    is_anchor_over_ = true;
  }
}

void OdometryOutput::renew_anchor() {
  anchor_ = anchor_.moved(state_.time_us(), state_.vehicle());
  state_.renew_anchor();
  next_anchor_us_.reset();
  is_anchor_over_ = false;
}

Odometry OdometryOutput::at_scan() {
  Odometry result = odometry(state_.vehicle(), anchor_, state_.time_us());
  result.is_new = state_.time_us() > output_us_;
  if (result.is_new) {
    add_motion(result);
  }
  result.odom_pose = odom_pose_;
  result.odom_covariance += drift_covariance_;
  return result;
}

Odometry OdometryOutput::odometry(const VehicleEstimate& vehicle, const Anchor& anchor,
                                  std::int64_t utime_us) const {
  Odometry result;
  result.utime_us = utime_us;
  result.utime_anchor_us = anchor.utime_us;
  result.pose = vehicle.mean.head<kPose>();
  result.covariance = symmetric(vehicle.covariance.topLeftCorner<kPose, kPose>());
  result.odom_covariance =
      anchor.moved(utime_us, vehicle).full_covariance(state_.options().lasting);
  add_twist(vehicle, result);
  return result;
}

/// Adds the motion since the last output and clones the pose as the new last output. Renews the
/// anchor if it is due.
void OdometryOutput::add_motion(Odometry& odometry) {
  const Eigen::Vector3d before = state_.gaussian.mean().segment<kPose>(kOutput);
  constexpr std::array<int, 6> kPoses{kOutput, kOutput + 1, kOutput + 2, kX, kY, kYaw};
  odometry.utime_before_us = output_us_;
  odometry.motion = relative_pose(before, odometry.pose);
  const auto jacobian = relative_pose_jacobian(before, odometry.motion);
  const Eigen::Matrix<double, 6, 6> covariance = state_.gaussian.covariance()(kPoses, kPoses);
  odometry.motion_covariance = symmetric(jacobian * covariance * jacobian.transpose());
  odometry.radars = radars_;
  odom_pose_ = composed_pose(odom_pose_, odometry.motion);
  const Eigen::Vector3d drift = odom_pose_ - composed_pose(anchor_.pose, odometry.pose);
  drift_covariance_ = drift * drift.transpose();
  output_us_ = state_.time_us();
  radars_since_prediction_ |= radars_;
  radars_ = 0;
  state_.clone_output();
  const OdometryOptions& options = state_.options();
  if (options.rate_hz == 0 &&
      seconds_between(anchor_.utime_us, output_us_) >= options.anchor_period_s) {
    renew_anchor();
  }
}

/// Predictions run ahead of the state, which stays at the last scan so that one measured before the
/// predicted time can still be used. They refer to a new anchor before the state gets there:
/// next_anchor_us_ is its time until advance_to() does.
std::optional<Odometry> OdometryOutput::predict_next(std::int64_t now_us) {
  const OdometryOptions& options = state_.options();
  const std::int64_t from_us = state_.time_us();
  const std::int64_t utime_us =
      next_multiple_us(std::max(predicted_us_, from_us - 1), options.rate_hz);
  if (utime_us > now_us || seconds_between(from_us, utime_us) > options.max_gap_s) {
    return std::nullopt;
  }
  const Odometry result = predicted(utime_us);
  predicted_us_ = utime_us;
  predicted_odom_pose_ = result.odom_pose;
  radars_since_prediction_ = 0;
  const bool is_over =
      is_anchor_over_ || seconds_between(anchor_.utime_us, utime_us) >= options.anchor_period_s;
  if (!next_anchor_us_ && is_over) {
    next_anchor_us_ = utime_us;
  }
  return result;
}

Odometry OdometryOutput::predicted(std::int64_t utime_us) const {
  const OdometryOptions& options = state_.options();
  VehicleEstimate vehicle = state_.vehicle();
  std::int64_t from_us = state_.time_us();
  Anchor anchor = anchor_;
  anchor.pose = odom_pose_of(Eigen::Vector3d::Zero());
  if (next_anchor_us_) {
    vehicle = vehicle.predicted(seconds_between(from_us, *next_anchor_us_), options);
    from_us = *next_anchor_us_;
    anchor = anchor.moved(from_us, vehicle);
    vehicle = vehicle.at_origin();
  }
  const double ahead_s = seconds_between(from_us, utime_us);
  Odometry result = odometry(vehicle.predicted(ahead_s, options), anchor, utime_us);
  result.is_new = true;
  result.utime_before_us = predicted_us_;
  result.odom_pose = composed_pose(anchor.pose, result.pose);
  result.odom_covariance += drift_covariance_;
  result.radars = radars_since_prediction_;
  return result;
}

}  // namespace cremed
