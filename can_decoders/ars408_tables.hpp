// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace cremed {

// The code tables of the ARS408. Codes that a table does not define are kept and match no
// enumerator.

/// Table D: motion of a target, correct only while the sensor receives the vehicle's speed.
enum class Ars408DynProp : std::uint8_t {
  moving,
  stationary,
  oncoming,
  stationary_candidate,
  unknown,
  crossing_stationary,
  crossing_moving,
  stopped,
};

/// Table M: ambiguity of a cluster's Doppler.
enum class Ars408Ambiguity : std::uint8_t {
  invalid,
  ambiguous,
  staggered_ramp,
  unambiguous,
  stationary_candidate,
};

/// Table I: state of a cluster. The sensor calls 1, 2, 3, 6, 7 and 14 invalid, the others valid
/// with a doubt; 5, 13 and 18 and above are undefined.
enum class Ars408InvalidState : std::uint8_t {
  valid = 0,
  invalid_low_rcs = 1,
  near_field_artefact = 2,
  far_not_confirmed_near = 3,
  low_rcs = 4,
  mirror = 6,
  outside_field_of_view = 7,
  azimuth_corrected_for_elevation = 8,
  high_child_probability = 9,
  artefact_at_50_deg = 10,
  no_local_maximum = 11,
  high_artefact_probability = 12,
  harmonic = 14,
  beyond_95_m_in_near_range = 15,
  high_multi_target_probability = 16,
  suspicious_angle = 17,
};

/// MeasState: origin of an object in this cycle.
enum class Ars408MeasurementState : std::uint8_t {
  deleted,
  created,
  measured,
  predicted,
  deleted_for_merge,
  created_by_merge,
};

/// Table R: upper bound of the standard deviation (m, m/s or m/s^2); nothing for 31, "invalid", and
/// above.
std::optional<double> ars408_rms(std::uint8_t index);

/// The standard deviation to use: root mean square over the interval from the next lower bound to
/// the index's own, a factor of 2000^(1/30), uniform in the logarithm.
std::optional<double> ars408_std(std::uint8_t index);

}  // namespace cremed
