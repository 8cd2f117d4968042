// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "cremed/can_decoders/bit_field.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"

/// The signals of a Bosch GPR's messages for SignalReader and SignalWriter: position (Intel order)
/// and scale of each.
namespace cremed::bosch_gpr_signals {

inline constexpr std::size_t kLength = 8;  // All three messages.
inline constexpr std::size_t kCrcByte = 7;
inline constexpr BitField kIsA{0, 1};
inline constexpr BitField kId{1, 6};
inline constexpr BitField kCounter{54, 2};  // Of all three.
inline constexpr BitField kAge{30, 13};

inline constexpr LinearScale kSixteenths{0.0, 16.0};
inline constexpr LinearScale kAzimuthStdScale{0.0, 1000.0};
inline constexpr LinearScale kAgeScale{0.0, 10000.0};

template <typename Signal>
void signals(const Signal& signal, BoschGprTargetA& m) {
  signal(kIsA, m.is_a);
  signal(kId, m.id);
  signal({7, 12}, kSixteenths, m.range_m);
  signal({19, 12, true}, kSixteenths, m.radial_velocity_mps);
  signal({31, 8, true}, {0.0, 2.0}, m.power_dbm2);
  signal({39, 14, true}, {0.0, 5000.0}, m.azimuth_rad);
  signal({53, 1}, m.measured);
  signal(kCounter, m.counter);
}

template <typename Signal>
void signals(const Signal& signal, BoschGprTargetB& m) {
  signal(kIsA, m.is_a);
  signal(kId, m.id);
  signal({7, 6}, kAzimuthStdScale, m.azimuth_std_rad);
  signal({13, 6}, kSixteenths, m.radial_velocity_std_mps);
  signal({19, 6}, kSixteenths, m.range_std_m);
  signal({25, 5}, {0.0, 32.0}, m.existence);
  signal(kAge, kAgeScale, m.age_s);
  signal(kCounter, m.counter);
}

template <typename Signal>
void signals(const Signal& signal, BoschGprInfo& m) {
  signal({0, 3}, m.sensor_type);
  signal({3, 8, true}, {-50.0, 1.0}, m.temperature_degc);
  signal({11, 1}, m.blind);
  signal({12, 1}, m.software_failure);
  signal({13, 1}, m.hardware_failure);
  signal({14, 1}, m.can_failure);
  signal({15, 1}, m.configuration_failure);
  signal({16, 1}, m.diagnostic_mode);
  signal({17, 24}, m.trouble_code);
  signal({41, 8}, m.trouble_order);
  signal({49, 1}, m.not_safe);
  signal(kCounter, m.counter);
}

}  // namespace cremed::bosch_gpr_signals

namespace cremed {

template <typename Content>
std::optional<Content> decode_bosch_gpr(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < bosch_gpr_signals::kLength) {
    return std::nullopt;
  }
  const PayloadBits bits = PayloadBits::little_endian(bytes);
  Content content;
  bosch_gpr_signals::signals(SignalReader(bits), content);
  return content;
}

}  // namespace cremed
