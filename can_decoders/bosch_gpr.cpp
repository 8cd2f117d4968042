// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/bosch_gpr.hpp"

#include <algorithm>

#include "cremed/can_decoders/bit_field.hpp"

namespace cremed {
namespace {

constexpr std::size_t kLength = 8;  // All three messages.
constexpr double kMinRangeM = 0.01;

// Common to all messages, Intel order.
constexpr BitField kCounter{54, 2};
constexpr std::size_t kCrcByte = 7;
constexpr std::uint8_t kIsA = 0;
constexpr BitField kId{1, 6};

namespace target_a {
constexpr BitField kRange{7, 12};
constexpr BitField kRadialVelocity{19, 12};
constexpr BitField kPower{31, 8};
constexpr BitField kAzimuth{39, 14};
constexpr std::uint8_t kMeasured = 53;
}  // namespace target_a

namespace target_b {
constexpr BitField kAzimuthStd{7, 6};
constexpr BitField kRadialVelocityStd{13, 6};
constexpr BitField kRangeStd{19, 6};
constexpr BitField kExistence{25, 5};
constexpr BitField kAge{30, 13};
}  // namespace target_b

namespace info {
constexpr BitField kSensorType{0, 3};
constexpr BitField kTemperature{3, 8};
constexpr int kTemperatureOffset = 50;
constexpr std::uint8_t kBlind = 11;
constexpr std::uint8_t kSoftwareFailure = 12;
constexpr std::uint8_t kHardwareFailure = 13;
constexpr std::uint8_t kCanFailure = 14;
constexpr std::uint8_t kConfigurationFailure = 15;
constexpr std::uint8_t kDiagnosticMode = 16;
constexpr BitField kTroubleCode{17, 24};
constexpr BitField kTroubleOrder{41, 8};
constexpr std::uint8_t kNotSafe = 49;
}  // namespace info

constexpr LinearScale kSixteenths{0.0, 16.0};
constexpr LinearScale kPowerScale{0.0, 2.0};
constexpr LinearScale kAzimuthScale{0.0, 5000.0};
constexpr LinearScale kAzimuthStdScale{0.0, 1000.0};
constexpr LinearScale kExistenceScale{0.0, 32.0};
constexpr LinearScale kAgeScale{0.0, 10000.0};

/// Used where the sensor gives 0: half a step of the scale.
double at_least_half_step(double std, LinearScale scale) { return std::max(std, scale(0.5)); }

Payload payload_of(const CanFrame& frame) {
  Payload payload;
  std::copy_n(frame.data.begin(), payload.size(), payload.begin());
  return payload;
}

}  // namespace

std::optional<BoschGprTargetA> decode_bosch_gpr_target_a(std::span<const std::uint8_t> bytes) {
  using namespace target_a;
  if (bytes.size() < kLength) {
    return std::nullopt;
  }
  const auto bits = PayloadBits::little_endian(bytes);
  return BoschGprTargetA{.is_a = bits.flag(kIsA),
                         .id = bits.get8(kId),
                         .range_m = kSixteenths(bits.get(kRange)),
                         .radial_velocity_mps = kSixteenths(bits.get_signed(kRadialVelocity)),
                         .power_dbm2 = kPowerScale(bits.get_signed(kPower)),
                         .azimuth_rad = kAzimuthScale(bits.get_signed(kAzimuth)),
                         .measured = bits.flag(kMeasured),
                         .counter = bits.get8(kCounter)};
}

std::optional<BoschGprTargetB> decode_bosch_gpr_target_b(std::span<const std::uint8_t> bytes) {
  using namespace target_b;
  if (bytes.size() < kLength) {
    return std::nullopt;
  }
  const auto bits = PayloadBits::little_endian(bytes);
  return BoschGprTargetB{.is_a = bits.flag(kIsA),
                         .id = bits.get8(kId),
                         .azimuth_std_rad = kAzimuthStdScale(bits.get(kAzimuthStd)),
                         .radial_velocity_std_mps = kSixteenths(bits.get(kRadialVelocityStd)),
                         .range_std_m = kSixteenths(bits.get(kRangeStd)),
                         .existence = kExistenceScale(bits.get(kExistence)),
                         .age_s = kAgeScale(bits.get(kAge)),
                         .counter = bits.get8(kCounter)};
}

std::optional<BoschGprInfo> decode_bosch_gpr_info(std::span<const std::uint8_t> bytes) {
  using namespace info;
  if (bytes.size() < kLength) {
    return std::nullopt;
  }
  const auto bits = PayloadBits::little_endian(bytes);
  const int temperature_degc = bits.get_signed(kTemperature) + kTemperatureOffset;
  return BoschGprInfo{.sensor_type = bits.get8(kSensorType),
                      .temperature_degc = static_cast<std::int16_t>(temperature_degc),
                      .blind = bits.flag(kBlind),
                      .software_failure = bits.flag(kSoftwareFailure),
                      .hardware_failure = bits.flag(kHardwareFailure),
                      .can_failure = bits.flag(kCanFailure),
                      .configuration_failure = bits.flag(kConfigurationFailure),
                      .diagnostic_mode = bits.flag(kDiagnosticMode),
                      .trouble_code = bits.get(kTroubleCode),
                      .trouble_order = bits.get8(kTroubleOrder),
                      .not_safe = bits.flag(kNotSafe),
                      .counter = bits.get8(kCounter)};
}

std::uint8_t crc8_j1850(std::span<const std::uint8_t> bytes) {
  unsigned crc = 0xFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 0x80U) != 0 ? (crc << 1U) ^ 0x11DU : crc << 1U;
    }
  }
  return static_cast<std::uint8_t>(crc ^ 0xFFU);
}

BoschGprDecoder::BoschGprDecoder(const BoschGprOptions& options) : options_(options) {
  last_counters_.fill(kAnyCounter);
}

std::size_t BoschGprDecoder::index_of(const CanFrame& frame) const {
  if (frame.extended || frame.error) {
    return kForeign;
  }
  if (frame.id >= options_.base_id && frame.id - options_.base_id < kGprTargetIds) {
    return frame.id - options_.base_id;
  }
  return frame.id == options_.info_id ? kInfoIndex : kForeign;
}

bool BoschGprDecoder::check_crc(const Payload& payload) {
  if (options_.crc_policy == CrcPolicy::off ||
      crc8_j1850(std::span(payload).first(kCrcByte)) == payload[kCrcByte]) {
    return true;
  }
  ++counters_.crc_errors;
  return options_.crc_policy == CrcPolicy::count;
}

bool BoschGprDecoder::check_slot(const Payload& payload, std::size_t index) {
  const auto bits = PayloadBits::little_endian(payload);
  const bool a_id = index % 2 == 0;
  const std::size_t id = bits.get(kId);
  const bool ours = bits.flag(kIsA) == a_id && id < kBoschGprSlots;
  if (!ours || id != index / 2) {
    ++counters_.wrong_slot;
  }
  return ours;
}

void BoschGprDecoder::check_counter(std::uint8_t counter, std::size_t index) {
  const std::uint8_t last = last_counters_[index];
  if (last != kAnyCounter && counter != (last + 1) % 4) {
    ++counters_.counter_errors;
  }
  last_counters_[index] = counter;
}

bool BoschGprDecoder::accept(const CanFrame& frame) {
  ++counters_.frames;
  if (frame.remote || frame.fd) {
    ++counters_.wrong_kind;
    return false;
  }
  if (frame.length < kLength) {
    ++counters_.wrong_length;
    return false;
  }
  return true;
}

bool BoschGprDecoder::trust(const Payload& payload, std::size_t index) {
  const bool trusted = check_crc(payload) && (index == kInfoIndex || check_slot(payload, index));
  if (!trusted) {
    last_counters_[index] = kAnyCounter;
  }
  return trusted;
}

ScanPart BoschGprDecoder::decode(const CanFrame& frame) {
  const std::size_t index = index_of(frame);
  if (index == kForeign || !accept(frame)) {
    return {};
  }
  const Payload payload = payload_of(frame);
  if (!trust(payload, index)) {
    return {};
  }
  const auto counter = PayloadBits::little_endian(payload).get8(kCounter);
  check_counter(counter, index);
  if (index == kInfoIndex) {
    ++counters_.state_frames;
    info_ = decode_bosch_gpr_info(payload);
    return {};
  }
  return {.kind = ScanPart::Kind::target,
          .message = static_cast<std::uint8_t>(index % 2),
          .slot = static_cast<std::uint8_t>(index / 2),
          .counter = counter,
          .stamp_us = frame.stamp_us,
          .payload = payload};
}

RadarHealth BoschGprDecoder::health() const {
  if (!info_) {
    return {};
  }
  return {.is_known = true,
          .faults = (info_->hardware_failure ? RadarHealth::persistent_error : 0U) |
                    (info_->blind ? RadarHealth::blind : 0U) |
                    (info_->software_failure ? RadarHealth::software_failure : 0U) |
                    (info_->can_failure ? RadarHealth::can_failure : 0U) |
                    (info_->configuration_failure ? RadarHealth::configuration_failure : 0U) |
                    (info_->not_safe ? RadarHealth::not_safe : 0U) |
                    (info_->trouble_code != 0 ? RadarHealth::trouble_code : 0U),
          .output = RadarHealth::Output::objects,
          .sends_quality = true};
}

Detection BoschGprDecoder::detection(const TargetPayload& target) const {
  const auto a = decode_bosch_gpr_target_a(target[0]);
  const auto b = decode_bosch_gpr_target_b(target[1]);
  if (!a->measured) {
    return {};
  }
  Detection detection{.range_m = a->range_m,
                      .doppler_mps = a->radial_velocity_mps * (options_.invert_doppler ? -1 : 1),
                      .rcs_dbm2 = a->power_dbm2,
                      .id = a->id,
                      .validity = Validity::no_position};
  if (a->range_m < kMinRangeM) {
    return detection;
  }
  detection.azimuth_rad = a->azimuth_rad * (options_.invert_azimuth ? -1 : 1);
  detection.range_std_m = at_least_half_step(b->range_std_m, kSixteenths);
  detection.azimuth_std_rad = at_least_half_step(b->azimuth_std_rad, kAzimuthStdScale);
  detection.doppler_std_mps = at_least_half_step(b->radial_velocity_std_mps, kSixteenths);
  detection.validity =
      b->existence < options_.min_existence ? Validity::low_existence : Validity::usable;
  return detection;
}

}  // namespace cremed
