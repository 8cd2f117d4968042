// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/can_decoders/bosch_gpr.hpp"

#include <algorithm>

#include "cremed/can_decoders/bosch_gpr_signals.hpp"

namespace cremed {
namespace {

using namespace bosch_gpr_signals;

constexpr double kMinRangeM = 0.01;

/// Used where the sensor gives 0: half a step of the scale.
double at_least_half_step(double std, LinearScale scale) {
  return std::max(std, 0.5 / scale.steps_per_unit);
}

}  // namespace

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

bool BoschGprDecoder::check_crc(const Payload& payload, std::size_t index) {
  if (options_.crc_policy == CrcPolicy::off ||
      crc8_j1850(std::span(payload).first(kCrcByte)) == payload[kCrcByte]) {
    return true;
  }
  ++counters_.crc_errors;
  // 0x100 is common: what another node sends there would be read as faults of the sensor.
  return options_.crc_policy == CrcPolicy::count && index != kInfoIndex;
}

bool BoschGprDecoder::check_slot(const Payload& payload, std::size_t index) {
  const auto bits = PayloadBits::little_endian(payload);
  const bool a_id = index % 2 == 0;
  const auto id = static_cast<std::size_t>(bits.get(kId));
  const bool ours = (bits.get(kIsA) != 0) == a_id && id < kBoschGprSlots;
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

bool BoschGprDecoder::trust(const Payload& payload, std::size_t index) {
  const bool trusted =
      check_crc(payload, index) && (index == kInfoIndex || check_slot(payload, index));
  if (!trusted) {
    last_counters_[index] = kAnyCounter;
  }
  return trusted;
}

ScanPart BoschGprDecoder::decode(const CanFrame& frame) {
  const std::size_t index = index_of(frame);
  if (index == kForeign || !accept(frame, kLength)) {
    return {};
  }
  Payload payload;
  std::copy_n(frame.data.begin(), payload.size(), payload.begin());
  if (!trust(payload, index)) {
    return {};
  }
  const auto counter = static_cast<std::uint8_t>(PayloadBits::little_endian(payload).get(kCounter));
  check_counter(counter, index);
  if (index == kInfoIndex) {
    ++counters_.state_frames;
    info_ = decode_bosch_gpr<BoschGprInfo>(payload);
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
  const auto a = decode_bosch_gpr<BoschGprTargetA>(target[0]);
  const auto b = decode_bosch_gpr<BoschGprTargetB>(target[1]);
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

// For users of the library, which has no header of the signals.
template std::optional<BoschGprTargetA> decode_bosch_gpr(std::span<const std::uint8_t> bytes);
template std::optional<BoschGprTargetB> decode_bosch_gpr(std::span<const std::uint8_t> bytes);
template std::optional<BoschGprInfo> decode_bosch_gpr(std::span<const std::uint8_t> bytes);

}  // namespace cremed
