// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Mostly valid frames of both families in any order, with arbitrary time, lost frames and ends of
// input: scans meet their guarantees and every part is counted.
#include <bitset>

#include "cremed/can_decoders/ars408.hpp"
#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/scan_assembler.hpp"
#include "test/fuzz/fuzz_input.hpp"

namespace {

using namespace cremed;
using fuzz::check;

constexpr std::int64_t kTimeoutUs = 50'000;

/// One radar and the scans of its assembler.
class Bench {
 public:
  explicit Bench(RadarDecoder& decoder)
      : decoder_(decoder), framing_(decoder.framing()), assembler_(decoder, kTimeoutUs) {}

  void receive(const CanFrame& frame) {
    const ScanPart part = decoder_.decode(frame);
    parts_ += part.kind != ScanPart::Kind::none ? 1 : 0;
    assembler_.add(part);
    take();
  }
  void expire(std::int64_t now_us) {
    assembler_.expire(now_us);
    take();
  }
  void mark_dropped() { assembler_.mark_dropped(); }
  void finish() {
    assembler_.finish();
    take();
    check_counters();
  }

 private:
  void take() {
    int taken = 0;
    while (const RadarScan* scan = assembler_.next()) {
      check(++taken <= 2);
      check_scan(*scan);
    }
  }

  void check_scan(const RadarScan& scan) {
    const bool complete = scan.status == ScanStatus::complete;
    check(scan.count <= kMaxDetections && scan.count <= scan.announced);
    check(scan.announced <= kMaxDetections || !complete);
    check(scan.counter < framing_.counter_modulus);
    if (framing_.has_header) {
      check(!complete || scan.count == scan.announced);
    } else {
      check(scan.announced == framing_.slot_count);
    }
    std::bitset<kMaxDetections> ids;
    for (std::size_t i = 0; i < scan.count; ++i) {
      fuzz::check_detection(scan.detections[i]);
      check(scan.detections[i].validity != Validity::empty && !ids[scan.detections[i].id]);
      ids.set(scan.detections[i].id);
    }
    ++scans_;
    incomplete_ += complete ? 0 : 1;
    empty_ += complete && scan.count == 0 ? 1 : 0;
    announced_ += scan.announced;
    detections_ += scan.count;
  }

  void check_counters() const {
    const AssemblerCounters& c = assembler_.counters();
    check(c.scans == scans_ && c.incomplete_scans == incomplete_ && c.empty_scans == empty_);
    check(c.timeouts <= c.incomplete_scans && c.missing_parts <= framing_.messages * announced_);
    // No scan is open now: each part was a header, went into a scan, or was refused.
    const std::uint64_t headers =
        framing_.has_header ? c.scans + c.repeated_scans - c.headerless_scans : 0;
    check(c.headerless_scans <= c.incomplete_scans);
    const std::uint64_t stored = framing_.messages * announced_ - c.missing_parts;
    check(framing_.messages * detections_ <= stored);
    check(parts_ == headers + stored + c.duplicate_parts + c.conflicting_parts + c.excess_parts +
                        c.orphan_parts);
  }

  RadarDecoder& decoder_;
  ScanFraming framing_;
  ScanAssembler assembler_;
  std::uint64_t parts_ = 0;
  std::uint64_t scans_ = 0;
  std::uint64_t incomplete_ = 0;
  std::uint64_t empty_ = 0;
  std::uint64_t announced_ = 0;
  std::uint64_t detections_ = 0;
};

struct Script {
  fuzz::Input input;
  std::int64_t now_us = 0;
};

CanFrame frame_of(const Script& script, std::uint32_t id, std::uint8_t length) {
  return {.stamp_us = script.now_us, .id = id, .length = length};
}

CanFrame header_frame(Script& script) {
  CanFrame frame = frame_of(script, 0x600, 5);
  frame.data[0] = script.input.byte();
  frame.data[1] = frame.data[0] == 255 ? script.input.byte() : 0;
  frame.data[3] = script.input.byte();
  return frame;
}

CanFrame cluster_frame(Script& script, bool first, std::uint8_t slot) {
  CanFrame frame = first ? frame_of(script, 0x701, 8) : frame_of(script, 0x702, 5);
  frame.data[0] = slot;
  frame.data[3] = script.input.byte() & 3U;  // Few values, so that repeats are often equal.
  return frame;
}

CanFrame slot_frame(Script& script, std::uint8_t slot, std::uint8_t what) {
  const bool is_a = (what & 1U) != 0;
  CanFrame frame = frame_of(script, 0x200U + 2U * (slot % 48U) + (is_a ? 0U : 1U), 8);
  frame.data[0] = static_cast<std::uint8_t>((is_a ? 1U : 0U) | (slot % 48U) << 1U);
  frame.data[1] = what >> 4U;
  frame.data[6] = static_cast<std::uint8_t>((what & 6U) << 5U | (what & 8U) << 2U);
  return frame;
}

/// A whole list or burst at once, because the fuzzer rarely finds all parts.
void list(Script& script, Bench& clusters, Bench& slots) {
  const std::uint8_t counter = script.input.byte();
  for (std::uint8_t slot = 0; slot < 48; ++slot) {
    for (const unsigned is_a : {1U, 0U}) {
      slots.receive(
          slot_frame(script, slot, static_cast<std::uint8_t>((counter & 3U) << 1U | is_a)));
    }
  }
  CanFrame header = header_frame(script);
  clusters.receive(header);
  for (const bool first : {true, false}) {
    for (unsigned slot = 0; slot < header.data[0]; ++slot) {
      CanFrame frame = cluster_frame(script, first, static_cast<std::uint8_t>(slot));
      clusters.receive(frame);
    }
  }
}

void step(Script& script, Bench& clusters, Bench& slots) {
  switch (script.input.byte() % 10) {
    case 0:
      clusters.receive(header_frame(script));
      break;
    case 1:
      clusters.receive(cluster_frame(script, true, script.input.byte()));
      break;
    case 2:
      clusters.receive(cluster_frame(script, false, script.input.byte()));
      break;
    case 3:
    case 4: {
      const std::uint8_t slot = script.input.byte();
      slots.receive(slot_frame(script, slot, script.input.byte()));
      break;
    }
    case 5:  // Time steps of up to 65 ms in either direction, and sometimes any time.
      script.now_us += std::int64_t{2} * static_cast<std::int16_t>(script.input.number(2));
      break;
    case 6:
      script.now_us = script.input.byte() == 7
                          ? static_cast<std::int64_t>(script.input.number(8)) / 2
                          : script.now_us + 100;
      break;
    case 7:
      clusters.expire(script.now_us + std::int64_t{1000} * script.input.byte());
      slots.expire(script.now_us + std::int64_t{1000} * script.input.byte());
      break;
    case 8:
      clusters.mark_dropped();
      slots.mark_dropped();
      break;
    default:
      script.input.byte() % 4 == 0 ? clusters.finish() : list(script, clusters, slots);
  }
}

}  // namespace

// The name is libFuzzer's. NOLINTNEXTLINE(readability-identifier-naming)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Ars408Decoder ars408({});
  BoschGprDecoder gpr({.crc_policy = CrcPolicy::off});
  Bench clusters(ars408);
  Bench slots(gpr);
  Script script{.input = {data, size}, .now_us = 1'000'000};
  while (!script.input.done()) {
    step(script, clusters, slots);
  }
  clusters.finish();
  slots.finish();
  return 0;
}
