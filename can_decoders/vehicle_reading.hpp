// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "cremed/can_decoders/can_frame.hpp"

namespace cremed {

/// What a vehicle's bus tells an ARS408 of the vehicle's motion.
enum class VehicleSignal : std::uint8_t {
  speed,     ///< 0x300 SpeedInformation: m/s, of the rear axle, negative backwards.
  yaw_rate,  ///< 0x301 YawRateInformation: rad/s, counter-clockwise.
};

inline constexpr std::size_t kVehicleSignals = 2;

/// Steps of the values in these messages.
inline constexpr double kVehicleSpeedStepMps = 0.02;
inline constexpr double kVehicleYawRateStepDegps = 0.01;

/// One value of a signal, as received.
struct VehicleReading {
  std::int64_t stamp_us = 0;
  VehicleSignal signal = VehicleSignal::speed;
  double value = 0.0;
};

/// The value in a frame with the layout of 0x300 or 0x301, whatever its identifier. None if the
/// frame is shorter than two bytes, no classic data frame, or contradicts itself: a speed other
/// than 0 at standstill, or a direction that does not exist.
std::optional<VehicleReading> decode_vehicle_reading(VehicleSignal signal, const CanFrame& frame);

}  // namespace cremed
