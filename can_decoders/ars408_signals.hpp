// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>

#include "cremed/can_decoders/ars408_messages.hpp"
#include "cremed/can_decoders/bit_field.hpp"
#include "cremed/can_decoders/can_frame.hpp"

/// The signals of an ARS408's messages for SignalReader and SignalWriter: position (Motorola order)
/// and scale of each.
namespace cremed::ars408_signals {

inline constexpr double kDegPerRad = 180.0 / std::numbers::pi;

template <typename Signal>
void signals(const Signal& signal, Ars408ClusterStatus& m) {
  signal({0, 8}, m.near_count);
  signal({8, 8}, m.far_count);
  signal({24, 16}, m.counter);
  signal({36, 4}, m.interface_version);
}

template <typename Signal>
void signals(const Signal& signal, Ars408ObjectStatus& m) {
  signal({0, 8}, m.count);
  signal({16, 16}, m.counter);
  signal({28, 4}, m.interface_version);
}

template <typename Signal>
void general_signals(const Signal& signal, Ars408General& m) {
  signal({0, 8}, m.id);
  signal({19, 13}, {2500.0, 5.0}, m.x_m);
  signal({46, 10}, {512.0, 4.0}, m.vx_mps);
  signal({53, 9}, {256.0, 4.0}, m.vy_mps);
  signal({48, 3}, m.dyn_prop);
  signal({56, 8}, {128.0, 2.0}, m.rcs_dbm2);
}

template <typename Signal>
void signals(const Signal& signal, Ars408Cluster& m) {
  general_signals(signal, m);
  signal({24, 10}, {511.5, 5.0}, m.y_m);
}

template <typename Signal>
void signals(const Signal& signal, Ars408Object& m) {
  general_signals(signal, m);
  signal({24, 11}, {1023.0, 5.0}, m.y_m);
}

template <typename Signal>
void signals(const Signal& signal, Ars408RmsCodes& m) {
  signal({11, 5}, m.x);
  signal({22, 5}, m.y);
  signal({17, 5}, m.vx);
  signal({28, 5}, m.vy);
}

template <typename Signal>
void signals(const Signal& signal, Ars408ClusterQuality& m) {
  signal({0, 8}, m.id);
  signals(signal, m.rms);
  signal({24, 3}, m.false_alarm_code);
  signal({35, 5}, m.invalid_state);
  signal({32, 3}, m.ambiguity);
}

template <typename Signal>
void signals(const Signal& signal, Ars408ObjectQuality& m) {
  signal({0, 8}, m.id);
  signals(signal, m.rms);
  signal({39, 5}, m.ax_rms_code);
  signal({34, 5}, m.ay_rms_code);
  signal({45, 5}, m.orientation_rms_code);
  signal({53, 3}, m.existence_code);
  signal({50, 3}, m.measurement_state);
}

template <typename Signal>
void signals(const Signal& signal, Ars408RadarState& m) {
  signal({6, 1}, m.nvm_read);
  signal({7, 1}, m.nvm_written);
  signal({22, 10}, {0.0, 0.5}, m.max_distance_m);
  signal({21, 1}, m.persistent_error);
  signal({20, 1}, m.interference);
  signal({19, 1}, m.temperature_error);
  signal({18, 1}, m.temporary_error);
  signal({17, 1}, m.voltage_error);
  signal({39, 3}, m.power_code);
  signal({36, 3}, m.sort_code);
  signal({32, 3}, m.sensor_id);
  // MotionRxState: 1 speed missing, 2 yaw rate missing, 3 both.
  signal({46, 1}, m.speed_missing);
  signal({47, 1}, m.yaw_rate_missing);
  signal({45, 1}, m.sends_extended);
  signal({44, 1}, m.sends_quality);
  signal({42, 2}, m.output_code);
  signal({41, 1}, m.relay_control);
  signal({58, 3}, m.rcs_threshold_code);
}

template <typename Signal>
void signals(const Signal& signal, Ars408Version& m) {
  signal({0, 8}, m.major_release);
  signal({8, 8}, m.minor_release);
  signal({16, 8}, m.patch_level);
  signal({25, 1}, m.extended_range);
  signal({24, 1}, m.power_restricted);
}

/// The limits of a filter have the width and scale of its criterion, the index here.
struct FilterLimits {
  std::uint8_t length;
  LinearScale scale;
};
inline constexpr LinearScale kCode{0.0, 1.0};
inline constexpr LinearScale kTenths{0.0, 10.0};
inline constexpr LinearScale kFilteredSpeed{0.0, 2000.0 / 63.0};
inline constexpr std::array<FilterLimits, 16> kFilterLimits{{
    {12, kCode},
    {12, kTenths},
    {12, {2000.0, 40.0 * kDegPerRad}},
    {12, kFilteredSpeed},
    {12, kFilteredSpeed},
    {12, {2000.0, 40.0}},
    {12, kTenths},
    {12, {0.0, 40.0}},
    {12, kCode},
    {12, {2047.5, 5.0}},
    {13, {2500.0, 5.0}},
    {12, kFilteredSpeed},
    {12, kFilteredSpeed},
    {12, kFilteredSpeed},
    {12, kFilteredSpeed},
    {8, kCode},
}};

/// Which filter 0x202 or 0x204 is about.
template <typename Signal>
void filter_signals(const Signal& signal, Ars408FilterState& m) {
  signal({7, 1}, m.for_objects);
  signal({3, 4}, m.criterion);
}

template <typename Signal>
void signals(const Signal& signal, Ars408FilterState& m) {
  filter_signals(signal, m);
  const FilterLimits& limits = kFilterLimits[static_cast<std::size_t>(m.criterion)];
  signal({2, 1}, m.active);
  signal({16, limits.length}, limits.scale, m.min);
  signal({32, limits.length}, limits.scale, m.max);
}

// 0x300 and 0x301.
inline constexpr BitField kDirection{6, 2};
inline constexpr std::uint8_t kStandstill = 0;
inline constexpr std::uint8_t kForward = 1;
inline constexpr std::uint8_t kBackward = 2;
inline constexpr BitField kSpeed{8, 13};
inline constexpr BitField kYawRate{8, 16};
inline constexpr LinearScale kSpeedScale{0.0, 50.0};
inline constexpr LinearScale kYawRateScale{32768.0, 100.0 * kDegPerRad};

/// A frame to or from the sensor with this id, without stamp and interface.
inline CanFrame frame(std::uint32_t base_id, std::uint8_t sensor_id, std::uint8_t length,
                      const PayloadBits& bits) {
  CanFrame result;
  result.id = ars408_id(base_id, sensor_id & 7U);
  result.length = length;
  for (std::size_t i = 0; i < length; ++i) {
    result.data[i] = bits.byte(i);
  }
  return result;
}

}  // namespace cremed::ars408_signals

namespace cremed {

template <typename Content>
std::optional<Content> decode_ars408(Ars408Bytes bytes) {
  static_assert(std::ranges::find(kArs408Messages, Content::kMessage, &Ars408MessageRow::message) !=
                std::ranges::end(kArs408Messages));
  const auto* row =
      std::ranges::find(kArs408Messages, Content::kMessage, &Ars408MessageRow::message);
  if (bytes.size() < row->length) {
    return std::nullopt;
  }
  const PayloadBits bits = PayloadBits::big_endian(bytes);
  Content content;
  ars408_signals::signals(SignalReader(bits), content);
  return content;
}

}  // namespace cremed
