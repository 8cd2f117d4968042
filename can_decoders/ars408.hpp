// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "can_decoders/radar_decoder.hpp"

namespace cremed {

/// What an ARS408 is set to send (RadarState OutputTypeCfg: 1 objects, 2 clusters).
enum class Ars408Output : std::uint8_t { clusters, objects };

struct Ars408Options {
  std::uint8_t sensor_id = 0;  ///< 0..7; every identifier is base + 0x10 * sensor_id.
  Ars408Output output = Ars408Output::clusters;
  /// Bit n set: keep clusters with InvalidState n (table I). Default: 0, 4, 11.
  std::uint32_t keep_invalid_states = (1U << 0U) | (1U << 4U) | (1U << 11U);
  /// Bit n set: keep targets with DynProp n (table D). Default: 1, 3, 5 (stationary).
  std::uint8_t keep_dyn_props = (1U << 1U) | (1U << 3U) | (1U << 5U);
  /// Objects with a smaller ProbOfExist code (table P, 0..7) are kept out. Default: 5, >= 90 %.
  std::uint8_t min_existence_code = 5;
};

}  // namespace cremed
