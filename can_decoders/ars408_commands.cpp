// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408_commands.hpp"

#include <cmath>

#include "cremed/can_decoders/ars408_signals.hpp"

namespace cremed {
namespace {

using namespace ars408_signals;

constexpr std::uint32_t kCommandId = 0x200;
constexpr std::uint32_t kFilterId = 0x202;
constexpr std::uint32_t kSpeedId = 0x300;
constexpr std::uint32_t kYawRateId = 0x301;

PayloadBits empty_bits() { return PayloadBits::big_endian({}); }

/// Writes a signal and its valid bit if it has a value. The sensor ignores a signal whose valid bit
/// is not set.
template <typename Code>
void put(PayloadBits& bits, std::uint8_t valid_bit, BitField field,
         const std::optional<Code>& code) {
  if (code) {
    bits.set({valid_bit, 1}, 1);
    bits.set(field, std::int64_t{*code});
  }
}

}  // namespace

CanFrame encode_ars408_command(std::uint8_t sensor_id, const Ars408Command& command) {
  PayloadBits bits = empty_bits();
  if (command.max_distance_m) {
    bits.set({0, 1}, 1);
    const SignalWriter signal(bits);
    signal({22, 10}, {0.0, 0.5}, *command.max_distance_m);
  }
  put(bits, 1, {32, 3}, command.sensor_id);
  put(bits, 2, {37, 3}, command.power_code);
  put(bits, 3, {35, 2}, command.output_code);
  put(bits, 4, {42, 1}, command.sends_quality);
  put(bits, 5, {43, 1}, command.sends_extended);
  put(bits, 6, {44, 3}, command.sort_code);
  put(bits, 7, {47, 1}, command.store);
  put(bits, 40, {41, 1}, command.relay_control);
  put(bits, 48, {49, 3}, command.rcs_threshold_code);
  return frame(kCommandId, sensor_id, 8, bits);
}

CanFrame encode_ars408_filter(std::uint8_t sensor_id, const Ars408FilterState& filter) {
  constexpr BitField kValid{1, 1};
  PayloadBits bits = empty_bits();
  Ars408FilterState content = filter;
  signals(SignalWriter(bits), content);
  bits.set(kValid, 1);
  return frame(kFilterId, sensor_id, 5, bits);
}

CanFrame encode_ars408_filter_query(std::uint8_t sensor_id, bool for_objects,
                                    Ars408Criterion criterion) {
  PayloadBits bits = empty_bits();
  Ars408FilterState asked{.for_objects = for_objects, .criterion = criterion};
  filter_signals(SignalWriter(bits), asked);
  return frame(kFilterId, sensor_id, 5, bits);
}

CanFrame encode_ars408_speed(std::uint8_t sensor_id, double speed_mps) {
  const std::int64_t speed = kSpeedScale.raw(std::abs(speed_mps), kSpeed);
  const std::uint8_t direction = speed == 0 ? kStandstill : speed_mps < 0.0 ? kBackward : kForward;
  PayloadBits bits = empty_bits();
  bits.set(kDirection, direction);
  bits.set(kSpeed, speed);
  return frame(kSpeedId, sensor_id, 2, bits);
}

CanFrame encode_ars408_yaw_rate(std::uint8_t sensor_id, double yaw_rate_radps) {
  PayloadBits bits = empty_bits();
  bits.set(kYawRate, kYawRateScale.raw(yaw_rate_radps, kYawRate));
  return frame(kYawRateId, sensor_id, 2, bits);
}

bool is_ars408_motion(std::uint32_t id, std::uint8_t sensor_id) {
  return id == ars408_id(kSpeedId, sensor_id) || id == ars408_id(kYawRateId, sensor_id);
}

}  // namespace cremed
