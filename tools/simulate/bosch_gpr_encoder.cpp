// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulate/bosch_gpr_encoder.hpp"

#include <span>

#include "cremed/can_decoders/bosch_gpr_signals.hpp"

namespace cremed {
namespace {

using namespace bosch_gpr_signals;

/// With its checksum.
void write(const PayloadBits& bits, CanFrame& frame) {
  frame.length = kLength;
  for (std::size_t i = 0; i < kCrcByte; ++i) {
    frame.data[i] = bits.byte(i);
  }
  frame.data[kCrcByte] = crc8_j1850(std::span(frame.data).first(kCrcByte));
}

template <typename Content>
CanFrame encoded(std::uint32_t id, Content content) {
  PayloadBits bits = PayloadBits::little_endian({});
  signals(SignalWriter(bits), content);
  CanFrame frame;
  frame.id = id;
  write(bits, frame);
  return frame;
}

}  // namespace

CanFrame encode_bosch_gpr(std::uint32_t base_id, const BoschGprTargetA& target) {
  BoschGprTargetA content = target;
  if (!target.measured) {
    content = {.id = target.id, .counter = target.counter};
  }
  content.is_a = true;
  return encoded(base_id + 2U * target.id, content);
}

CanFrame encode_bosch_gpr(std::uint32_t base_id, const BoschGprTargetB& target) {
  return encoded(base_id + 2U * target.id + 1U, target);
}

void set_bosch_gpr_age(CanFrame& target_b, std::int64_t age_us) {
  PayloadBits bits = PayloadBits::little_endian(std::span(target_b.data).first(kLength));
  bits.set(kAge, kAgeScale.raw(1e-6 * static_cast<double>(age_us), kAge));
  write(bits, target_b);
}

CanFrame encode_bosch_gpr_info(std::uint32_t info_id, const BoschGprInfo& info) {
  return encoded(info_id, info);
}

}  // namespace cremed
