// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/can_decoders/vehicle_reading.hpp"
#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"

namespace cremed {

/// Index of the rate that a signal tells; its derivative is the next.
inline int rate_of(VehicleSignal signal) {
  return signal == VehicleSignal::speed ? state_layout::kSpeed : state_layout::kYawRate;
}
/// Index of the signal's scale, for OdometryState::vehicle_error.
inline int scale_of(VehicleSignal signal) {
  return signal == VehicleSignal::speed ? state_layout::kSpeedScale : state_layout::kYawRateGain;
}

/// A value of a signal of the vehicle's bus, measured `age_s` before the state (<= 0: at its time);
/// (12) of the README:
///
///     v = v - a age,   w = w - c age
///     speed     z = (1 + b_v) v
///     yaw rate  z = (1 + g_w) w + h
///
/// b_v and g_w scales, h bias. Besides, a signal errs by an Ornstein-Uhlenbeck process of standard
/// deviation s and correlation time T. It is no state: measurements at an interval dt have a noise
/// of variance s^2 max(1, 2 T / dt), whose integral over time has the variance of the process's.
/// Noise is also added for the step of the values, and for the delay's error times acceleration.
///
/// The first number of the LinearMeasurement.
struct VehicleMeasurement {
  const OdometryState& state;
  VehicleSignal signal;
  double age_s;
  double interval_s;  ///< Since the last measurement of this signal.

  [[nodiscard]] LinearMeasurement linearise(double value) const;

 private:
  [[nodiscard]] double variance(double value) const;
};

}  // namespace cremed
