// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "can_decoders/radar_decoder.hpp"

namespace cremed {

/// off: not checked. count: checked and counted, frame used. enforce: counted and frame dropped.
enum class CrcPolicy : std::uint8_t { off, count, enforce };

struct BoschGprOptions {
  std::uint32_t base_id = 0x200;  ///< Message A of slot k: base + 2 k, B: base + 2 k + 1.
  std::uint32_t info_id = 0x100;
  CrcPolicy crc_policy = CrcPolicy::count;
  bool invert_azimuth = false;    ///< true: the sensor counts azimuth positive to the right.
  bool invert_doppler = false;    ///< true: the sensor's radial velocity is positive when closing.
  double min_existence = 0.0;     ///< Targets with a smaller pExist (0..0.96875) are kept out.
};

}  // namespace cremed
