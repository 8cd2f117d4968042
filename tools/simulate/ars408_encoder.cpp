// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/ars408_encoder.hpp"

#include <algorithm>
#include <cmath>

namespace cremed {
namespace {

/// Conversion of a physical value to the raw number in a frame.
struct Scale {
  double step;
  double least;
  std::uint32_t bits;
};

constexpr Scale kX{kArs408DistanceStepM, -500.0, 13};
constexpr Scale kClusterY{kArs408DistanceStepM, -102.3, 10};
constexpr Scale kObjectY{kArs408DistanceStepM, -204.6, 11};
constexpr Scale kXSpeed{kArs408SpeedStepMps, -128.0, 10};
constexpr Scale kYSpeed{kArs408SpeedStepMps, -64.0, 9};
constexpr Scale kRcs{0.5, -64.0, 8};

std::uint32_t raw_value(double value, const Scale& scale) {
  const double greatest = static_cast<double>((1U << scale.bits) - 1U);
  const double raw = std::round((value - scale.least) / scale.step);
  return static_cast<std::uint32_t>(std::clamp(raw, 0.0, greatest));
}

template <typename Code>
std::uint32_t bits_of(Code code) {
  return static_cast<std::uint32_t>(code);
}

std::uint32_t flag(bool set, std::uint32_t bit) { return set ? 1U << bit : 0U; }

std::uint8_t byte(std::uint32_t value) { return static_cast<std::uint8_t>(value & 0xFFU); }

CanFrame frame(Ars408Message message, std::uint8_t sensor_id, std::uint8_t length) {
  CanFrame result;
  result.id = ars408_id(bits_of(message), sensor_id);
  result.length = length;
  return result;
}

CanFrame general(Ars408Message message, std::uint8_t sensor_id, const Ars408General& target,
                 const Scale& y_scale) {
  const std::uint32_t x = raw_value(target.x_m, kX);
  const std::uint32_t y = raw_value(target.y_m, y_scale);
  const std::uint32_t vx = raw_value(target.vx_mps, kXSpeed);
  const std::uint32_t vy = raw_value(target.vy_mps, kYSpeed);
  CanFrame result = frame(message, sensor_id, 8);
  result.data[0] = target.id;
  result.data[1] = byte(x >> 5U);
  result.data[2] = byte((x << 3U) | (y >> 8U));
  result.data[3] = byte(y);
  result.data[4] = byte(vx >> 2U);
  result.data[5] = byte((vx << 6U) | (vy >> 3U));
  result.data[6] = byte((vy << 5U) | (bits_of(target.dyn_prop) & 7U));
  result.data[7] = byte(raw_value(target.rcs_dbm2, kRcs));
  return result;
}

/// Both quality messages begin alike; `rest` is the lower half of byte 3.
void put_rms(CanFrame& result, std::uint8_t id, const Ars408RmsCodes& rms, std::uint32_t rest) {
  result.data[0] = id;
  result.data[1] = byte((bits_of(rms.x) << 3U) | (bits_of(rms.y) >> 2U));
  result.data[2] = byte((bits_of(rms.y) << 6U) | (bits_of(rms.vx) << 1U) | (bits_of(rms.vy) >> 4U));
  result.data[3] = byte((bits_of(rms.vy) << 4U) | rest);
}

}  // namespace

std::uint8_t ars408_rms_code(double standard_deviation) {
  std::uint8_t code = 0;
  while (code < 30 && ars408_rms(code).value_or(0.0) < standard_deviation) ++code;
  return code;
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ClusterStatus& status) {
  CanFrame result = frame(Ars408Message::cluster_status, sensor_id, 5);
  result.data = {status.near_count, status.far_count, byte(bits_of(status.counter) >> 8U),
                 byte(status.counter), byte(bits_of(status.interface_version) << 4U)};
  return result;
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ObjectStatus& status) {
  CanFrame result = frame(Ars408Message::object_status, sensor_id, 4);
  result.data = {status.count, byte(bits_of(status.counter) >> 8U), byte(status.counter),
                 byte(bits_of(status.interface_version) << 4U)};
  return result;
}

CanFrame encode_ars408_cluster(std::uint8_t sensor_id, const Ars408General& cluster) {
  return general(Ars408Message::cluster_general, sensor_id, cluster, kClusterY);
}

CanFrame encode_ars408_object(std::uint8_t sensor_id, const Ars408General& object) {
  return general(Ars408Message::object_general, sensor_id, object, kObjectY);
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ClusterQuality& quality) {
  CanFrame result = frame(Ars408Message::cluster_quality, sensor_id, 5);
  put_rms(result, quality.id, quality.rms, quality.false_alarm_code & 7U);
  result.data[4] = byte((bits_of(quality.invalid_state) << 3U) | (bits_of(quality.ambiguity) & 7U));
  return result;
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408ObjectQuality& quality) {
  const std::uint32_t ax = quality.ax_rms_code;
  const std::uint32_t ay = quality.ay_rms_code;
  const std::uint32_t orientation = quality.orientation_rms_code;
  CanFrame result = frame(Ars408Message::object_quality, sensor_id, 7);
  put_rms(result, quality.id, quality.rms, ax >> 1U);
  result.data[4] = byte((ax << 7U) | (ay << 2U) | (orientation >> 3U));
  result.data[5] = byte(orientation << 5U);
  result.data[6] =
      byte((bits_of(quality.existence_code) << 5U) | (bits_of(quality.measurement_state) << 2U));
  return result;
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408RadarState& state) {
  const std::uint32_t distance = raw_value(state.max_distance_m, {2.0, 0.0, 10});
  const std::uint32_t power = state.power_code;
  CanFrame result = frame(Ars408Message::radar_state, sensor_id, 8);
  result.data[0] = byte(flag(state.nvm_written, 7) | flag(state.nvm_read, 6));
  result.data[1] = byte(distance >> 2U);
  result.data[2] = byte((distance << 6U) | flag(state.persistent_error, 5) |
                        flag(state.interference, 4) | flag(state.temperature_error, 3) |
                        flag(state.temporary_error, 2) | flag(state.voltage_error, 1));
  result.data[3] = byte((power >> 1U) & 3U);
  result.data[4] = byte((power << 7U) | (bits_of(state.sort_code) << 4U) | (state.sensor_id & 7U));
  result.data[5] = byte(flag(state.yaw_rate_missing, 7) | flag(state.speed_missing, 6) |
                        flag(state.sends_extended, 5) | flag(state.sends_quality, 4) |
                        (bits_of(state.output_code) << 2U) | flag(state.relay_control, 1));
  result.data[7] = byte(bits_of(state.rcs_threshold_code) << 2U);
  return result;
}

CanFrame encode_ars408(std::uint8_t sensor_id, const Ars408Version& version) {
  CanFrame result = frame(Ars408Message::version, sensor_id, 4);
  result.data = {version.major_release, version.minor_release, version.patch_level,
                 byte(flag(version.extended_range, 1) | flag(version.power_restricted, 0))};
  return result;
}

}  // namespace cremed
