// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/can_decoders/radar_scan.hpp"

namespace cremed {

/// An ARS408 is told the vehicle's yaw rate w, and it reports the positions of its targets turned
/// on by w tau: as if the vehicle had already turned for another tau, its rotation lead. Velocities
/// are those of the stamp. With the true line of sight u of a static target, its normal t (u turned
/// by +90 degrees), its range r and the velocity v_s of the sensor, in the sensor's frame,
///
///     reported line of sight   u' = R(-w tau) u
///     reported velocity        V  = D u + A t,    D = -v_s' u (Doppler),   A = -v_s' t - w r
///
/// so that V projected on u' exceeds the Doppler that a model at u' predicts, -v_s' u', by
///
///     V' u' + v_s' u' = tau w^2 r
///
/// and a registration of scans a and b finds the turn between t_a + tau and t_b + tau. Both go away
/// when positions are turned back by +w tau and V is projected on the line of sight u so found.
///
/// w is what the sensor itself put into the velocities: A is linear in v_s and w. A sensor that is
/// not told speed and yaw rate reports A = 0: then w = 0 and nothing is turned. Source: measured on
/// nuScenes, where w so found is the gyro's to 0.003 rad/s with slope 1.00 (front and rear radars
/// of four drives) and tau = 0.041 s (front), 0.038 s (rear), +- 0.0003 s.

/// The yaw rate w that the velocities across the line of sight of a scan's usable detections show,
/// by robust least squares; 0 where they show none.
double reported_yaw_rate_radps(const RadarScan& scan);

/// The detection with its line of sight turned by `angle_rad` and its velocity projected on that.
Detection turned(const Detection& detection, double angle_rad);

}  // namespace cremed
