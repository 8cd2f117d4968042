// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arbitrary frames to a Bosch GPR decoder with arbitrary options, every message decoder, and
// detections from two arbitrary payloads: values stay finite and in range, and every frame is
// counted.
#include <algorithm>
#include <cmath>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/bosch_gpr_signals.hpp"
#include "test/fuzz/fuzz_input.hpp"

namespace {

using namespace cremed;
using fuzz::check;

void check_messages(std::span<const std::uint8_t> bytes) {
  const auto a = decode_bosch_gpr<BoschGprTargetA>(bytes);
  const auto b = decode_bosch_gpr<BoschGprTargetB>(bytes);
  const auto info = decode_bosch_gpr<BoschGprInfo>(bytes);
  check(a.has_value() == (bytes.size() >= 8));
  check(b.has_value() == a.has_value() && info.has_value() == a.has_value());
  if (!a) {
    return;
  }
  check(a->range_m >= 0.0 && a->range_m < 256.0);
  check(std::abs(a->radial_velocity_mps) <= 128.0 && std::abs(a->power_dbm2) <= 64.0);
  check(std::abs(a->azimuth_rad) <= 1.6384 && a->counter < 4 && a->id < 64);
  check(b->range_std_m >= 0.0 && b->range_std_m < 4.0 && b->radial_velocity_std_mps < 4.0);
  check(b->azimuth_std_rad <= 0.063 && b->existence < 1.0 && b->age_s < 0.82);
  check(info->temperature_degc >= -78 && info->temperature_degc <= 177);
  check(info->trouble_code < 1U << 24U);
}

}  // namespace

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const std::uint8_t mode = input.byte();
  BoschGprOptions options{.base_id = static_cast<std::uint32_t>(input.number(2)),
                          .info_id = static_cast<std::uint32_t>(input.number(2))};
  options.crc_policy = static_cast<CrcPolicy>(mode % 3);
  options.invert_azimuth = (mode & 8U) != 0;
  options.invert_doppler = (mode & 16U) != 0;
  options.min_existence = (mode >> 5U) / 8.0;
  BoschGprDecoder decoder(options);

  TargetPayload target;
  std::uint64_t parts = 0;
  while (!input.done()) {
    const std::uint8_t choice = input.byte();
    CanFrame frame = input.frame(choice < 96 ? options.base_id + choice : 0);
    if (choice % 4 != 3) {  // Most checksums are correct; otherwise no frame would pass.
      frame.data[7] = crc8_j1850(std::span(frame.data).first(7));
    }
    const ScanPart part = decoder.decode(frame);
    parts += part.kind != ScanPart::Kind::none ? 1 : 0;
    check(part.slot < kBoschGprSlots && part.counter < 4);
    check(part.message < decoder.framing().messages);
    target[part.message] = part.payload;
    fuzz::check_detection(decoder.detection(target));
    check_messages(std::span(frame.data).first(std::min<std::size_t>(frame.length, 64)));
  }
  const DecoderCounters& c = decoder.counters();
  const std::uint64_t refused = c.frames - parts - c.state_frames - c.wrong_length - c.wrong_kind;
  check(refused <= c.wrong_slot + c.crc_errors && c.wrong_mode == 0);
  check(c.counter_errors <= parts + c.state_frames);
  return 0;
}
