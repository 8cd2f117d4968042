// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace cremed {

/// A radar's latest report about itself, for every family. The bits are those of status_t.
struct RadarHealth {
  enum Fault : std::uint32_t {
    persistent_error = 1U << 0U,  ///< ARS408; GPR: hardware failure.
    temporary_error = 1U << 1U,
    temperature_error = 1U << 2U,
    voltage_error = 1U << 3U,
    interference = 1U << 4U,
    blind = 1U << 5U,
    software_failure = 1U << 6U,
    can_failure = 1U << 7U,
    configuration_failure = 1U << 8U,
    not_safe = 1U << 9U,
    trouble_code = 1U << 10U,
    speed_missing = 1U << 11U,     ///< The ARS408 receives no 0x300.
    yaw_rate_missing = 1U << 12U,  ///< The ARS408 receives no 0x301.
  };
  enum class Output : std::uint8_t { unknown = 0, objects = 1, clusters = 2, none = 3 };

  bool is_known = false;  ///< The radar has reported.
  std::uint32_t faults = 0;
  Output output = Output::unknown;
  bool sends_quality = false;
  double max_distance_m = 0.0;  ///< Configured far limit; 0: unknown.
};

}  // namespace cremed
