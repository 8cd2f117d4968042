// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/vehicle_reading.hpp"

#include <span>

#include "cremed/can_decoders/ars408_signals.hpp"

namespace cremed {
namespace {

using namespace ars408_signals;

constexpr std::uint8_t kMinLength = 2;

std::optional<double> speed_of(const PayloadBits& bits) {
  const std::int64_t raw = bits.get(kSpeed);
  switch (bits.get(kDirection)) {
    case kStandstill:
      return raw == 0 ? std::optional(0.0) : std::nullopt;
    case kForward:
      return kSpeedScale(raw);
    case kBackward:
      return -kSpeedScale(raw);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::optional<VehicleReading> decode_vehicle_reading(VehicleSignal signal, const CanFrame& frame) {
  if (!frame.is_classic_data() || frame.length < kMinLength) {
    return std::nullopt;
  }
  const PayloadBits bits = PayloadBits::big_endian(std::span(frame.data).first(kMinLength));
  const std::optional<double> value = signal == VehicleSignal::speed
                                          ? speed_of(bits)
                                          : std::optional(kYawRateScale(bits.get(kYawRate)));
  return value ? std::optional(VehicleReading{frame.stamp_us, signal, *value}) : std::nullopt;
}

}  // namespace cremed
