// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "cremed/can_decoders/bosch_gpr.hpp"

namespace cremed::test {

/// A message of a Bosch GPR at 0x200 with a correct checksum; `own_id` is its target number.
struct GprFrame {
  unsigned slot = 0;
  bool is_a = true;
  unsigned counter = 0;
  bool measured = true;
  unsigned own_id = slot;

  [[nodiscard]] CanFrame at(std::int64_t stamp_us = 0) const {
    CanFrame frame{.stamp_us = stamp_us, .id = 0x200 + 2 * slot + (is_a ? 0U : 1U), .length = 8};
    frame.data[0] = static_cast<std::uint8_t>((is_a ? 1U : 0U) | own_id << 1U);
    frame.data[1] = 80;  // A: 10 m.
    frame.data[6] = static_cast<std::uint8_t>(counter << 6U | (is_a && measured ? 0x20U : 0U));
    frame.data[7] = crc8_j1850(std::span(frame.data).first(7));
    return frame;
  }
};

}  // namespace cremed::test
