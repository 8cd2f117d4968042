// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/fusion/gaussian_state.hpp"
#include "cremed/estimator/fusion/linear_measurement.hpp"
#include "cremed/estimator/fusion/odometry_options.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"
#include "cremed/estimator/scan/pose2.hpp"

namespace cremed {

/// What the state says about the measurements of one radar, mounted at (l_x, l_y), linearised.
struct MeasurementModel {
  const GaussianState& state;
  const OdometryOptions& options;
  Pose2 vehicle_from_radar;
  int first;  ///< state_layout::radar().

  /// The velocity by Doppler of a scan that is `age_s` older than the state (<= 0: of its time):
  ///
  ///     v = v - a age,   w = w - c age,   V_x = v + m - w (l_y + e_y)
  ///     z_x = V_x (1 + b + b_c) + u_x + k_x (o + o_c)
  ///     z_y = s v + w (l_x + e_x) - d V_x + u_y + k_y (o + o_c)
  ///
  /// d mount yaw, e lever arm, b Doppler scale (b_c of all radars), u errors of the velocity, o of
  /// all Doppler (o_c of all radars), k DopplerVelocity::per_offset. m, u, o are those of a vehicle
  /// that drives: times min(1, |v| / kRollingMps), held fixed in derivatives. d V_y is left out of
  /// z_x: it is small, but through it the smallest disagreement in x would turn the slip.
  [[nodiscard]] LinearMeasurement doppler(const DopplerVelocity& velocity, double age_s) const;

  /// y and yaw of a registered pair, with (dx, dy, dpsi) the pose of clone `scan` in the frame of
  /// clone `keyframe`:
  ///
  ///     z_y = dy - d (dx - dpsi l_y) + q dx
  ///     z_psi = dpsi (1 + g + g_c) + r dx
  ///
  /// d mount yaw, q lateral error over distance, g scale of yaw (g_c of all radars), r error of yaw
  /// over distance. x is left to the Doppler, which tells it far better.
  [[nodiscard]] LinearMeasurement position(int keyframe, int scan,
                                           const Eigen::Vector3d& motion) const;
  /// The motion (x, y, yaw) that a registration between the two clones is expected to find.
  [[nodiscard]] Eigen::Vector3d expected_motion(int keyframe, const Eigen::Vector3d& scan) const;

 private:
  /// What the vehicle did since a scan that is older than the state.
  void add_lateness(double age_s, LinearMeasurement& measurement) const;
  [[nodiscard]] Eigen::Vector2d apparent(const Eigen::Vector3d& relative) const;
  [[nodiscard]] double at(int error) const { return state.mean(first + error); }
};

}  // namespace cremed
