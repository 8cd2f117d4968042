// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "cremed/estimator/fusion/state/linear_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/motion/doppler_velocity.hpp"

namespace cremed {

/// The velocity of a radar, mounted at (l_x, l_y), by the Doppler of a scan that is `age_s` older
/// than the state (<= 0: at its time); (10) of the README:
///
///     v = v - a age,   w = w - c age,   V_x = v + m - w (l_y + e_y)
///     z_x = V_x (1 + b + b_c) + u_x + k_x o + r(v) e_c + e_m
///     z_y = s v + w (l_x + e_x) - d V_x + u_y + k_y o
///
/// d mount yaw, e lever arm, b Doppler scale (b_c common to all radars), u errors of the velocity,
/// o offset of all Doppler, k DopplerVelocity::per_offset, e_c rounding of all Doppler of all
/// radars, r(v) rounding_share(), e_m shift by slow cars. m, u, o vanish at rest: they are
/// multiplied by min(1, |v| / kDrivingMps), held fixed in derivatives. d V_y is left out of z_x: it
/// is small, but would couple small errors in x to the slip.
struct DopplerMeasurement {
  const OdometryState& state;
  std::size_t radar;
  double age_s;

  [[nodiscard]] LinearMeasurement linearise(const DopplerVelocity& velocity) const;

 private:
  /// Adds the process noise since the scan.
  void add_lateness(LinearMeasurement& measurement) const;
};

}  // namespace cremed
