// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Arbitrary frames to an ARS408 decoder with arbitrary options, every message decoder, and
// detections from two arbitrary payloads: values stay finite and in range, and every frame is
// counted exactly once.
#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/ars408_signals.hpp"
#include "test/fuzz/fuzz_input.hpp"

namespace {

using namespace cremed;
using fuzz::check;

void check_finite(std::initializer_list<double> values) {
  check(std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }));
}

void check_general(const Ars408General& g, double max_y_m) {
  check(g.x_m >= -500.0 && g.x_m <= 1138.2);
  check(std::abs(g.y_m) <= max_y_m);
  check(std::abs(g.vx_mps) <= 128.0 && std::abs(g.vy_mps) <= 64.0);
  check(std::abs(g.rcs_dbm2) <= 64.0 && static_cast<unsigned>(g.dyn_prop) < 8);
}

void check_targets(Ars408Bytes bytes) {
  if (const auto g = decode_ars408<Ars408Cluster>(bytes)) {
    check_general(*g, 102.3);
  }
  if (const auto g = decode_ars408<Ars408Object>(bytes)) {
    check_general(*g, 204.8);
  }
  if (const auto q = decode_ars408<Ars408ClusterQuality>(bytes)) {
    check(q->rms.x < 32 && q->rms.y < 32 && q->rms.vx < 32 && q->rms.vy < 32);
    check(static_cast<unsigned>(q->invalid_state) < 32);
  }
  if (const auto q = decode_ars408<Ars408ObjectQuality>(bytes)) {
    check(ars408_rms(q->ax_rms_code).has_value() == (q->ax_rms_code < 31));
  }
  check(decode_ars408<Ars408ClusterStatus>(bytes).has_value() == (bytes.size() >= 5));
  check(decode_ars408<Ars408ObjectStatus>(bytes).has_value() == (bytes.size() >= 4));
}

void check_reports(Ars408Bytes bytes) {
  if (const auto s = decode_ars408<Ars408RadarState>(bytes)) {
    check(s->max_distance_m >= 0.0 && s->max_distance_m <= 2046.0);
  }
  if (const auto f = decode_ars408<Ars408FilterState>(bytes)) {
    check_finite({f->min, f->max});
  }
}

}  // namespace

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Input input(data, size);
  const std::uint8_t mode = input.byte();
  Ars408Options options{.sensor_id = static_cast<std::uint8_t>(mode & 7U)};
  options.output = (mode & 8U) != 0 ? Ars408Output::objects : Ars408Output::clusters;
  options.keep_invalid_states = static_cast<std::uint32_t>(input.number(4));
  options.keep_dyn_props = input.byte();
  options.min_existence_code = input.byte();
  Ars408Decoder decoder(options);

  TargetPayload target;
  std::uint64_t parts = 0;
  while (!input.done()) {
    const std::size_t choice = input.byte();
    const CanFrame frame =
        input.frame(choice < kArs408Messages.size()
                        ? static_cast<std::uint32_t>(kArs408Messages[choice].message) +
                              0x10U * options.sensor_id
                        : 0);
    const ScanPart part = decoder.decode(frame);
    parts += part.kind != ScanPart::Kind::none ? 1 : 0;
    check(part.target_count <= 510);
    check(part.message < decoder.framing().messages);
    target[part.message] = part.payload;
    fuzz::check_detection(decoder.detection(target));

    const auto bytes = std::span(frame.data).first(std::min<std::size_t>(frame.length, 64));
    check_targets(bytes);
    check_reports(bytes);
  }
  const DecoderCounters& c = decoder.counters();
  check(c.frames == parts + c.state_frames + c.wrong_length + c.wrong_kind + c.wrong_mode);
  return 0;
}
