// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "cremed/can_decoders/ars408_messages.hpp"

namespace cremed {

/// Less than the period of 0x201, one second.
inline constexpr std::int64_t kArs408ShortestStateGapUs = 400'000;

/// Separates the 0x201 of a sensor from those of another device with the same identifier (a GPR):
/// the sensor's own names its id and comes once a second.
class Ars408StateWatch {
 public:
  /// Judges one frame with the identifier. Frames with equal stamps pass the period check.
  bool is_own(std::uint8_t sensor_id, const std::optional<Ars408RadarState>& state,
              std::int64_t stamp_us) {
    const std::int64_t gap_us = stamp_us - last_us_.value_or(stamp_us);
    last_us_ = stamp_us;
    return state && state->sensor_id == sensor_id &&
           (gap_us <= 0 || gap_us >= kArs408ShortestStateGapUs);
  }

 private:
  std::optional<std::int64_t> last_us_;
};

}  // namespace cremed
