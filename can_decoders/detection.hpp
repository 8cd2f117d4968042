// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// Whether a detection may enter an estimate. All but `usable` are kept in the scan and counted.
enum class Validity : std::uint8_t {
  usable,
  no_noise,       ///< The sensor gave no usable standard deviation (rms index 31, or no quality).
  invalid_state,  ///< State code not among those to keep.
  moving,         ///< Motion class not among those to keep.
  low_existence,  ///< Probability of existence below the limit.
  no_position,    ///< Range too small to define an azimuth.
  empty,          ///< The slot holds no target; never stored in a scan.
};

/// The target's own motion as the sensor classifies it.
enum class Motion : std::uint8_t { unknown, moving, stationary };

/// One radar detection in the radar's own polar frame: x forward, y left, azimuth
/// counter-clockwise, Doppler = d(range)/dt (negative when closing). Standard deviations are one
/// sigma and greater than zero if and only if `validity` is not `no_noise`, `no_position`, `empty`.
struct Detection {
  double range_m = 0.0;
  double azimuth_rad = 0.0;
  double doppler_mps = 0.0;
  /// Velocity across the line of sight, counter-clockwise. Not measured: an ARS408 computes it for
  /// a static target from the speed and yaw rate it receives; 0 where the sensor gives none.
  double across_mps = 0.0;
  double range_std_m = 0.0;
  double azimuth_std_rad = 0.0;
  double doppler_std_mps = 0.0;
  double rcs_dbm2 = 0.0;
  std::uint16_t id = 0;  ///< The sensor's number of the target within this scan.
  Motion motion = Motion::unknown;
  Validity validity = Validity::empty;
};

}  // namespace cremed
