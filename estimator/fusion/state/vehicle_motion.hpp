// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/odometry_options.hpp"
#include "cremed/estimator/fusion/state/state_layout.hpp"

namespace cremed {

/// How a vehicle moves on, and what is not known of it:
///
///     x' = v cos psi - s v sin psi     y' = v sin psi + s v cos psi     psi' = w
///     v' = a    a' = -a / T_a + noise    w' = c    c' = -c / T_c + noise    s' = noise
///     m' = -m / T_m + noise
///
/// (x, y, psi) pose, v speed, a acceleration, w yaw rate, c yaw acceleration, s slip, m velocity of
/// the body over v, in the order of state_layout. Acceleration as an Ornstein-Uhlenbeck process:
/// Singer, IEEE Trans. Aerosp. Electron. Syst. 1970. Integrated by the midpoint rule.
struct MotionStep {
  using Vector = Eigen::Matrix<double, state_layout::kMotionStates, 1>;
  using Matrix = Eigen::Matrix<double, state_layout::kMotionStates, state_layout::kMotionStates>;

  Vector state;
  Matrix jacobian;
  Matrix noise;
};

/// `dt_s` may be negative: the state at an earlier time, accelerations held.
MotionStep moved(const MotionStep::Vector& state, double dt_s, const OdometryOptions& options);

/// Accelerations are constant within so short a step.
inline constexpr double kMaxMotionStepS = 0.1;

/// What is known of the vehicle.
struct VehicleEstimate {
  MotionStep::Vector mean;
  MotionStep::Matrix covariance;

  /// Once it has moved on.
  [[nodiscard]] VehicleEstimate predicted(double dt_s, const OdometryOptions& options) const;
  /// In the frame of its own pose, which is known there.
  [[nodiscard]] VehicleEstimate at_origin() const;
};

}  // namespace cremed
