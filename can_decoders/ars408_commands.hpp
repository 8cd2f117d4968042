// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

/// 0x200 RadarCfg: the settings to change. The sensor keeps all others and answers with its next
/// 0x201, sent once a second. Codes are those of Ars408RadarState.
struct Ars408Command {
  std::optional<double> max_distance_m{};  ///< In steps of 2 m.
  std::optional<std::uint8_t> sensor_id{};
  std::optional<std::uint8_t> power_code{};
  std::optional<std::uint8_t> output_code{};
  std::optional<bool> sends_quality{};
  std::optional<bool> sends_extended{};
  std::optional<std::uint8_t> sort_code{};
  std::optional<bool> store{};  ///< Write all settings to flash. Flash wears: never repeat it.
  std::optional<bool> relay_control{};
  std::optional<std::uint8_t> rcs_threshold_code{};
};

// Frames to the sensor, without stamp and interface; `sensor_id` is its present id. Values are
// clamped to the range of the signal; NaN becomes 0.

CanFrame encode_ars408_command(std::uint8_t sensor_id, const Ars408Command& command);

/// 0x202: sets this filter, in flash too. The sensor answers with 0x203 and 0x204.
CanFrame encode_ars408_filter(std::uint8_t sensor_id, const Ars408FilterState& filter);

/// 0x202 that changes nothing but makes the sensor answer.
CanFrame encode_ars408_filter_query(std::uint8_t sensor_id, bool for_objects,
                                    Ars408Criterion criterion);

/// 0x300, to be sent at least every 500 ms; negative is backwards. In steps of 0.02 m/s.
CanFrame encode_ars408_speed(std::uint8_t sensor_id, double speed_mps);

/// 0x301, to be sent at least every 500 ms; counter-clockwise. In steps of 0.01 deg/s.
CanFrame encode_ars408_yaw_rate(std::uint8_t sensor_id, double yaw_rate_radps);

/// Whether that is the identifier of one of the last two.
bool is_ars408_motion(std::uint32_t id, std::uint8_t sensor_id);

}  // namespace cremed
