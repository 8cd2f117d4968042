// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/fusion/state/state_layout.hpp"

namespace cremed {

/// One step of the motion model, with its Jacobian and process noise; (9) of the README:
///
///     x' = v cos psi - b v sin psi     y' = v sin psi + b v cos psi     psi' = w
///     v' = a    a' = -a / T_a + noise    w' = c    c' = -c / T_c + noise
///     b = s - k v w    s' = -s / T_s + noise    m' = -m / T_m + noise    k' = 0
///
/// (x, y, psi) pose, v speed, a acceleration, w yaw rate, c yaw acceleration, s slip, m velocity of
/// the body over v, k slip per centripetal acceleration, in the order of state_layout. a, c, s and
/// m are Ornstein-Uhlenbeck processes (Singer, IEEE Trans. Aerosp. Electron. Syst. 1970).
/// Integrated by the midpoint rule.
struct MotionStep {
  using Vector = Eigen::Matrix<double, state_layout::kMotionStates, 1>;
  using Matrix = Eigen::Matrix<double, state_layout::kMotionStates, state_layout::kMotionStates>;

  Vector state;
  Matrix jacobian;
  Matrix noise;
};

/// If `dt_s` is negative, the state at an earlier time with constant accelerations.
/// `skid_variance`: OdometryState::skid_variance().
MotionStep moved(const MotionStep::Vector& state, double dt_s, const OdometryOptions& options,
                 double skid_variance = 0.0);

/// Variance (rad^2) of the change of the slip in `dt_s` in a skid.
double skid_noise(double skid_variance, double dt_s);

/// The process of the yaw acceleration at a speed v: std / sqrt(1 + (v std / lateral jerk)^2). In a
/// skid the driver does not keep the lateral jerk small.
OrnsteinUhlenbeck yaw_acceleration_at(double speed_mps, const OdometryOptions& options,
                                      double skid_variance = 0.0);

/// Variance of a rate after `dt_s`, by the noise of its derivative since.
double rate_variance(const OrnsteinUhlenbeck& derivative, double dt_s);

/// Variance of x and of y by the product of the errors of way and heading, y = way * psi / 2, which
/// the first order lacks. After a time at unknown speed, with mean 0, it is all there is of y.
double variance_by_product(const Eigen::Ref<const Eigen::Matrix3d>& pose_covariance);

/// Of a skid, from one side to the other.
inline constexpr double kSkidS = 1.0;

/// Longest step: accelerations are nearly constant in it.
inline constexpr double kMaxMotionStepS = 0.1;

/// Estimate of the vehicle's motion states.
struct VehicleEstimate {
  MotionStep::Vector mean;
  MotionStep::Matrix covariance;
  double skid_variance = 0.0;  ///< OdometryState::skid_variance().

  /// The estimate after `dt_s`.
  [[nodiscard]] VehicleEstimate predicted(double dt_s, const OdometryOptions& options) const;
  /// The estimate in the frame of its own pose, which is known there.
  [[nodiscard]] VehicleEstimate at_origin() const;
};

}  // namespace cremed
