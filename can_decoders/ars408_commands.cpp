// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/ars408_commands.hpp"

#include <cmath>
#include <cstddef>

#include "cremed/can_decoders/ars408_layout.hpp"
#include "cremed/can_decoders/ars408_messages.hpp"
#include "cremed/can_decoders/bit_field.hpp"

namespace cremed {
namespace {

namespace layout = ars408_layout;

constexpr std::uint32_t kCommandId = 0x200;
constexpr std::uint32_t kFilterId = 0x202;
constexpr std::uint32_t kSpeedId = 0x300;
constexpr std::uint32_t kYawRateId = 0x301;

PayloadBits empty_bits() { return PayloadBits::big_endian({}); }

CanFrame frame(std::uint32_t base_id, std::uint8_t sensor_id, std::uint8_t length,
               const PayloadBits& bits) {
  CanFrame result;
  result.id = ars408_id(base_id, sensor_id & 7U);
  result.length = length;
  for (std::size_t i = 0; i < length; ++i) {
    result.data[i] = bits.byte(i);
  }
  return result;
}

/// Writes a signal and its valid bit if it has a value.
template <typename Code>
void put(PayloadBits& bits, std::uint8_t valid_bit, BitField field,
         const std::optional<Code>& code) {
  if (code) {
    bits.set({valid_bit, 1}, 1);
    bits.set(field, std::uint32_t{*code});
  }
}

PayloadBits filter_bits(bool for_objects, Ars408Criterion criterion) {
  PayloadBits bits = empty_bits();
  bits.set({layout::filter::kForObjects, 1}, for_objects ? 1 : 0);
  bits.set(layout::filter::kIndex, static_cast<std::uint32_t>(criterion));
  return bits;
}

}  // namespace

CanFrame encode_ars408_command(std::uint8_t sensor_id, const Ars408Command& command) {
  using namespace layout::configuration;
  PayloadBits bits = empty_bits();
  if (command.max_distance_m) {
    bits.set({kMaxDistanceValid, 1}, 1);
    bits.set(kMaxDistance, kMaxDistanceScale.raw(*command.max_distance_m, kMaxDistance));
  }
  put(bits, kSensorIdValid, kSensorId, command.sensor_id);
  put(bits, kPowerValid, kPower, command.power_code);
  put(bits, kOutputValid, kOutput, command.output_code);
  put(bits, kSendsQualityValid, kSendsQuality, command.sends_quality);
  put(bits, kSendsExtendedValid, kSendsExtended, command.sends_extended);
  put(bits, kSortValid, kSort, command.sort_code);
  put(bits, kStoreValid, kStore, command.store);
  put(bits, kRelayControlValid, kRelayControl, command.relay_control);
  put(bits, kRcsThresholdValid, kRcsThreshold, command.rcs_threshold_code);
  return frame(kCommandId, sensor_id, 8, bits);
}

CanFrame encode_ars408_filter(std::uint8_t sensor_id, const Ars408FilterState& filter) {
  using namespace layout::filter;
  const Limits& limits = kLimits[static_cast<std::size_t>(filter.criterion)];
  const BitField min{kMin, limits.length};
  const BitField max{kMax, limits.length};
  PayloadBits bits = filter_bits(filter.for_objects, filter.criterion);
  bits.set({kActive, 1}, filter.active ? 1 : 0);
  bits.set({kValid, 1}, 1);
  bits.set(min, limits.scale.raw(filter.min, min));
  bits.set(max, limits.scale.raw(filter.max, max));
  return frame(kFilterId, sensor_id, 5, bits);
}

CanFrame encode_ars408_filter_query(std::uint8_t sensor_id, bool for_objects,
                                    Ars408Criterion criterion) {
  return frame(kFilterId, sensor_id, 5, filter_bits(for_objects, criterion));
}

CanFrame encode_ars408_speed(std::uint8_t sensor_id, double speed_mps) {
  using namespace layout::motion;
  const std::uint32_t speed = kSpeedScale.raw(std::abs(speed_mps), kSpeed);
  const std::uint8_t direction = speed == 0 ? kStandstill : speed_mps < 0.0 ? kBackward : kForward;
  PayloadBits bits = empty_bits();
  bits.set(kDirection, direction);
  bits.set(kSpeed, speed);
  return frame(kSpeedId, sensor_id, 2, bits);
}

CanFrame encode_ars408_yaw_rate(std::uint8_t sensor_id, double yaw_rate_radps) {
  using namespace layout::motion;
  PayloadBits bits = empty_bits();
  bits.set(kYawRate, kYawRateScale.raw(yaw_rate_radps, kYawRate));
  return frame(kYawRateId, sensor_id, 2, bits);
}

bool is_ars408_motion(std::uint32_t id, std::uint8_t sensor_id) {
  return id == ars408_id(kSpeedId, sensor_id) || id == ars408_id(kYawRateId, sensor_id);
}

}  // namespace cremed
