// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/can_decoders/radar_scan.hpp"

namespace cremed {

/// An ARS408 receives the vehicle's yaw rate w and reports target positions turned by w tau, as if
/// the vehicle had turned for another time tau, the rotation lead. Velocities refer to the stamp.
/// With the true line of sight u of a static target, its normal t (u turned by +90 degrees), its
/// range r and the velocity v_s of the sensor, in the sensor's frame,
///
///     reported line of sight   u' = R(-w tau) u
///     reported velocity        V  = D u + A t,    D = -v_s' u (Doppler),   A = -v_s' t - w r
///
/// V projected on u' therefore exceeds the Doppler -v_s' u' that a model at u' predicts by
///
///     V' u' + v_s' u' = tau w^2 r
///
/// and a registration of scans a and b finds the turn between t_a + tau and t_b + tau. To correct
/// both errors, positions are turned back by +w tau and V is projected on the resulting line of
/// sight u.
///
/// w is estimated from the velocities that the sensor reports, because A is linear in v_s and w. A
/// sensor that does not receive speed and yaw rate reports A = 0; then w = 0 and nothing is turned.
/// Source: measured on nuScenes. There, w agrees with the gyro to 0.003 rad/s with slope 1.00
/// (front and rear radars of four drives), and tau = 0.041 s (front), 0.038 s (rear), +- 0.0003 s.

/// The yaw rate w, estimated by robust least squares from the velocities across the line of sight
/// of the usable detections; 0 if they are all 0.
double reported_yaw_rate_radps(const RadarScan& scan);

/// The detection with its line of sight turned by `angle_rad` and its velocity projected onto it.
Detection turned(const Detection& detection, double angle_rad);

}  // namespace cremed
