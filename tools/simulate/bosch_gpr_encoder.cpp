// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/bosch_gpr_encoder.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace cremed {
namespace {

constexpr std::int64_t kAgeStepUs = 100;
constexpr std::int64_t kGreatestAge = (1 << 13) - 1;
constexpr double kTemperatureOffsetDegc = 50.0;

/// The payload as one little-endian number, filled field by field.
class Word {
 public:
  void put(std::uint32_t start, std::uint32_t bits, std::uint64_t value) {
    const std::uint64_t mask = (std::uint64_t{1} << bits) - 1U;
    value_ = (value_ & ~(mask << start)) | ((value & mask) << start);
  }

  void put_signed(std::uint32_t start, std::uint32_t bits, double value, double step) {
    const double limit = static_cast<double>(std::uint64_t{1} << (bits - 1U));
    const double raw = std::clamp(std::round(value / step), -limit, limit - 1.0);
    put(start, bits, static_cast<std::uint64_t>(static_cast<std::int64_t>(raw)));
  }

  void put_unsigned(std::uint32_t start, std::uint32_t bits, double value, double step) {
    const double greatest = static_cast<double>((std::uint64_t{1} << bits) - 1U);
    put(start, bits,
        static_cast<std::uint64_t>(std::clamp(std::round(value / step), 0.0, greatest)));
  }

  void read(const CanFrame& frame) {
    value_ = 0;
    for (std::uint32_t i = 0; i < 7; ++i) {
      value_ |= static_cast<std::uint64_t>(frame.data[i]) << (8U * i);
    }
  }

  void write(CanFrame& frame) const;

 private:
  std::uint64_t value_ = 0;
};

void Word::write(CanFrame& frame) const {
  for (std::uint32_t i = 0; i < 7; ++i) {
    frame.data[i] = static_cast<std::uint8_t>((value_ >> (8U * i)) & 0xFFU);
  }
  frame.length = 8;
  frame.data[7] = crc8_j1850(std::span(frame.data).first(7));
}

CanFrame finished(std::uint32_t id, Word word, std::uint8_t counter) {
  word.put(54, 2, counter);
  CanFrame result;
  result.id = id;
  word.write(result);
  return result;
}

}  // namespace

CanFrame encode_bosch_gpr(std::uint32_t base_id, const BoschGprTargetA& target) {
  Word word;
  word.put(0, 1, 1);
  word.put(1, 6, target.id);
  if (target.measured) {
    word.put_unsigned(7, 12, target.range_m, kGprRangeStepM);
    word.put_signed(19, 12, target.radial_velocity_mps, kGprDopplerStepMps);
    word.put_signed(31, 8, target.power_dbm2, 0.5);
    word.put_signed(39, 14, target.azimuth_rad, kGprAzimuthStepRad);
    word.put(53, 1, 1);
  }
  return finished(base_id + 2U * target.id, word, target.counter);
}

CanFrame encode_bosch_gpr(std::uint32_t base_id, const BoschGprTargetB& target) {
  Word word;
  word.put(1, 6, target.id);
  word.put_unsigned(7, 6, target.azimuth_std_rad, kGprAzimuthStdStepRad);
  word.put_unsigned(13, 6, target.radial_velocity_std_mps, kGprDopplerStepMps);
  word.put_unsigned(19, 6, target.range_std_m, kGprRangeStepM);
  word.put_unsigned(25, 5, target.existence, 1.0 / 32.0);
  word.put_unsigned(30, 13, target.age_s, 1e-6 * static_cast<double>(kAgeStepUs));
  return finished(base_id + 2U * target.id + 1U, word, target.counter);
}

void set_bosch_gpr_age(CanFrame& target_b, std::int64_t age_us) {
  const std::int64_t steps = (age_us + kAgeStepUs / 2) / kAgeStepUs;
  Word word;
  word.read(target_b);
  word.put(30, 13, static_cast<std::uint64_t>(std::clamp<std::int64_t>(steps, 0, kGreatestAge)));
  word.write(target_b);
}

CanFrame encode_bosch_gpr_info(std::uint32_t info_id, const BoschGprInfo& info) {
  Word word;
  word.put(0, 3, info.sensor_type);
  word.put_signed(3, 8, info.temperature_degc - kTemperatureOffsetDegc, 1.0);
  word.put(11, 1, info.blind ? 1 : 0);
  word.put(12, 1, info.software_failure ? 1 : 0);
  word.put(13, 1, info.hardware_failure ? 1 : 0);
  word.put(14, 1, info.can_failure ? 1 : 0);
  word.put(15, 1, info.configuration_failure ? 1 : 0);
  word.put(16, 1, info.diagnostic_mode ? 1 : 0);
  word.put(17, 24, info.trouble_code);
  word.put(41, 8, info.trouble_order);
  word.put(49, 1, info.not_safe ? 1 : 0);
  return finished(info_id, word, info.counter);
}

}  // namespace cremed
