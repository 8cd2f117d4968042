// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

/// Steps of the values in the frames.
inline constexpr double kArs408DistanceStepM = 0.2;
inline constexpr double kArs408SpeedStepMps = 0.25;

/// The smallest index of table R that covers a standard deviation, at most 30.
std::uint8_t ars408_rms_code(double standard_deviation);

/// The sensor's messages as frames without stamp and interface; `sensor_id` shifts the identifier.
/// Values are clamped to the range of the frame.
CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ClusterStatus& status);
CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ClusterQuality& quality);
CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ObjectStatus& status);
CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ObjectQuality& quality);
CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408RadarState& state);
CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408Version& version);
CanFrame encode_ars408_cluster(std::uint8_t sensor_id, const Ars408General& cluster);
CanFrame encode_ars408_object(std::uint8_t sensor_id, const Ars408General& object);

}  // namespace cremed
