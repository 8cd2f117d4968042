// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/scan_assembler.hpp"

namespace cremed::test {

inline constexpr std::int64_t kTimeoutUs = 50'000;

inline constexpr ScanFraming kWithHeader{true, 65536, 256, 2};

/// A radar family without a payload format: the first byte of the first and the last payload is
/// passed on in the detection; 255 in the first is an empty slot.
class PlainDecoder final : public RadarDecoder {
 public:
  explicit PlainDecoder(const ScanFraming& framing) : framing_(framing) {}

  ScanPart decode(const CanFrame&) override { return {}; }
  [[nodiscard]] ScanFraming framing() const override { return framing_; }
  [[nodiscard]] RadarHealth health() const override { return {}; }
  [[nodiscard]] Detection detection(const TargetPayload& target) const override {
    return {.range_m = static_cast<double>(target[0][0]),
            .range_std_m = static_cast<double>(
                target[std::min<std::size_t>(framing_.messages, kMaxMessages) - 1][0]),
            .validity = target[0][0] == 255 ? Validity::empty : Validity::usable};
  }

 private:
  ScanFraming framing_;
};

/// An assembler whose scans are collected.
class ScanBench {
 public:
  explicit ScanBench(const ScanFraming& framing) : decoder_(framing) {}

  /// Each part comes 100 us after the last one unless its stamp is set.
  std::int64_t now_us = 1'000'000;

  void header(std::uint16_t counter, std::uint16_t target_count) {
    add({.kind = ScanPart::Kind::header, .counter = counter, .target_count = target_count});
  }
  void message(std::uint8_t number, std::uint8_t slot, std::uint8_t value = 1,
               std::uint16_t counter = 0) {
    add({.kind = ScanPart::Kind::target,
         .message = number,
         .slot = slot,
         .counter = counter,
         .payload = {value}});
  }
  void first(std::uint8_t slot, std::uint8_t value = 1, std::uint16_t counter = 0) {
    message(0, slot, value, counter);
  }
  void second(std::uint8_t slot, std::uint8_t value = 1, std::uint16_t counter = 0) {
    message(1, slot, value, counter);
  }
  /// Header, all first and all second messages of slots 0..count-1.
  void list(std::uint16_t counter, std::uint16_t count, std::uint8_t value = 1) {
    header(counter, count);
    for (std::uint16_t slot = 0; slot < count; ++slot) {
      first(static_cast<std::uint8_t>(slot), value);
    }
    for (std::uint16_t slot = 0; slot < count; ++slot) {
      second(static_cast<std::uint8_t>(slot), value);
    }
  }
  void expire(std::int64_t stamp_us) {
    assembler_.expire(stamp_us);
    collect();
  }
  void finish() {
    assembler_.finish();
    collect();
  }
  void mark_dropped() { assembler_.mark_dropped(); }

  [[nodiscard]] auto open_stamp_us() const { return assembler_.open_stamp_us(); }
  [[nodiscard]] auto awaited_parts() const { return assembler_.awaited_parts(); }
  [[nodiscard]] const AssemblerCounters& counters() const { return assembler_.counters(); }
  std::vector<RadarScan> scans;
  std::size_t most_waiting = 0;  ///< Most scans that one call closed.

 private:
  void add(ScanPart part) {
    part.stamp_us = now_us;
    now_us += 100;
    assembler_.add(part);
    collect();
  }
  void collect() {
    const std::size_t before = scans.size();
    while (const RadarScan* scan = assembler_.next()) {
      scans.push_back(*scan);
    }
    most_waiting = std::max(most_waiting, scans.size() - before);
  }

  PlainDecoder decoder_;
  ScanAssembler assembler_{decoder_, kTimeoutUs};
};

}  // namespace cremed::test
