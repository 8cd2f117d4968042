// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <vector>

#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

TEST_CASE("256 targets fit") {
  ScanBench bench(kWithHeader);
  bench.list(1, 256);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.scans[0].count == 256);
  CHECK(bench.scans[0].detections[255].id == 255);
}

TEST_CASE("More than 256 announced targets are over capacity") {
  ScanBench bench(kWithHeader);
  bench.header(1, 300);
  for (unsigned slot = 0; slot < 256; ++slot) {
    bench.first(static_cast<std::uint8_t>(slot));
    bench.second(static_cast<std::uint8_t>(slot));
  }
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::over_capacity);
  CHECK(bench.scans[0].announced == 300);
  CHECK(bench.scans[0].count == 256);
  CHECK(bench.counters().missing_parts == 88);
}

TEST_CASE("Over capacity hides conflicts and missing parts") {
  ScanBench bench(kWithHeader);
  bench.header(1, 257);
  bench.first(0, 1);
  bench.first(0, 2);
  bench.finish();
  CHECK(bench.scans.at(0).status == ScanStatus::over_capacity);
  CHECK(bench.counters().missing_parts == 2 * 257 - 1);
}

TEST_CASE("A conflict hides missing parts") {
  ScanBench bench(kWithHeader);
  bench.header(1, 2);
  bench.first(0, 1);
  bench.first(0, 2);
  bench.finish();
  CHECK(bench.scans.at(0).status == ScanStatus::conflicting_parts);
  CHECK(bench.counters().missing_parts == 3);
}

TEST_CASE("Lost frames spoil the open scan, and hide no contradiction in it") {
  struct Row {
    std::uint16_t announced;
    bool has_conflict;
    ScanStatus status;
  };
  for (const Row& row :
       {Row{1, false, ScanStatus::dropped_frames}, Row{1, true, ScanStatus::conflicting_parts},
        Row{300, false, ScanStatus::over_capacity}, Row{300, true, ScanStatus::over_capacity}}) {
    CAPTURE(row.announced, row.has_conflict);
    ScanBench bench(kWithHeader);
    bench.header(1, row.announced);
    bench.first(0);
    bench.mark_dropped();
    if (row.has_conflict) {
      bench.first(0, 9);
    }
    bench.second(0);
    bench.finish();
    REQUIRE(bench.scans.size() == 1);
    CHECK(bench.scans[0].status == row.status);
    CHECK(bench.scans[0].count == 1);
    CHECK(bench.counters().incomplete_scans == 1);
  }
}

TEST_CASE("Lost frames between scans spoil none") {
  ScanBench bench(kWithHeader);
  bench.mark_dropped();
  bench.list(1, 1);
  bench.mark_dropped();
  bench.list(2, 1);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.scans[1].status == ScanStatus::complete);
}

TEST_CASE("Skipped counters are missed scans") {
  struct Row {
    std::vector<std::uint16_t> counters;
    std::uint64_t missed;
  };
  const std::vector<Row> rows = {
      {{1, 2, 3, 4}, 0},
      {{1, 3, 5, 7}, 0},
      {{1, 2, 5}, 2},
      {{1, 3, 7, 9, 15}, 1 + 2},
      {{1, 5, 7, 9}, 0},                  // 4 first: nothing smaller is known yet.
      {{1, 3, 6}, 0},                     // One and a half cycles.
      {{65534, 65535, 0, 1}, 0},          // Wrap by one.
      {{65533, 65535, 1, 3}, 0},          // Wrap by two.
      {{65531, 65533, 1}, 1},             // A gap over the wrap.
      {{40000, 40002, 12000, 12002}, 0},  // Back: a restart.
      {{100, 102, 0, 2, 6}, 1},
      {{0, 1, 32769}, 32767},  // Half the range is the largest gap.
      {{0, 1, 32770}, 0},
      {{0, 2, 4, 5, 7, 9, 11}, 0},         // One glitch is no shorter cycle.
      {{0, 4, 5, 6, 9}, 2},                // A first step over a gap.
      {{0, 1, 3, 5, 6, 7, 9, 11, 12}, 4},  // Losses are no longer cycle.
  };
  for (const Row& row : rows) {
    ScanBench bench(kWithHeader);
    for (const std::uint16_t counter : row.counters) {
      bench.now_us += 3'600'000'000;  // Time enough for any gap.
      bench.list(counter, 1);
    }
    CAPTURE(row.counters);
    CHECK(bench.scans.size() == row.counters.size());
    CHECK(bench.counters().missed_scans == row.missed);
  }
}

TEST_CASE("More cycles than the time holds are a restart, not missed scans") {
  struct Row {
    std::int64_t pause_us;
    std::uint64_t missed;
  };
  for (const Row& row : {Row{3'000'000, 0}, Row{3'600'000'000, 12767}}) {
    CAPTURE(row.pause_us);
    ScanBench bench(kWithHeader);
    for (const std::uint16_t counter : std::vector<std::uint16_t>{39998, 40000}) {
      bench.list(counter, 1);
      bench.now_us += 75'000;
    }
    bench.now_us += row.pause_us;
    for (const std::uint16_t counter : std::vector<std::uint16_t>{0, 2, 8}) {  // Two are missing.
      bench.list(counter, 1);
      bench.now_us += 200'000;
    }
    CHECK(bench.counters().missed_scans == row.missed + 2);
  }
}

TEST_CASE("A first step that was a glitch is forgotten") {
  ScanBench bench(kWithHeader);
  bench.list(1, 1);
  for (std::uint16_t counter = 2; counter < 42; counter = static_cast<std::uint16_t>(counter + 2)) {
    bench.now_us += 75'000;
    bench.list(counter, 1);
  }
  const std::uint64_t missed = bench.counters().missed_scans;
  CHECK(missed < 20);
  for (std::uint16_t counter = 42; counter < 82;
       counter = static_cast<std::uint16_t>(counter + 2)) {
    bench.now_us += 75'000;
    bench.list(counter, 1);
  }
  CHECK(bench.counters().missed_scans == missed);
}

TEST_CASE("Repeated and incomplete scans are not missed ones") {
  ScanBench bench(kWithHeader);
  bench.list(1, 1);
  bench.list(1, 1);
  bench.header(2, 5);
  bench.list(3, 1);
  CHECK(bench.counters().missed_scans == 0);
}

TEST_CASE("Equal stamps are no step back") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.now_us -= 100;
  bench.first(0);
  CHECK(bench.counters().stamps_backwards == 0);
}

TEST_CASE("A repeated header, a duplicate and an excess part keep a scan from expiring") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.now_us += kTimeoutUs / 2;
  bench.header(1, 1);
  bench.now_us += kTimeoutUs - 200;
  bench.first(0);
  bench.now_us += kTimeoutUs - 200;
  bench.first(0);
  bench.now_us += kTimeoutUs - 200;
  bench.first(1);
  bench.now_us += kTimeoutUs - 200;
  bench.second(0);
  CHECK(bench.counters().timeouts == 0);
  CHECK(bench.scans.size() == 1);
}

TEST_CASE("A small step back in time is counted and harmless") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.now_us -= kTimeoutUs / 2;
  bench.first(0);
  bench.second(0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.counters().stamps_backwards == 1);
}

TEST_CASE("A step back beyond the time-out closes the open scan") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.first(0);
  bench.now_us -= 3'600'000'000;
  bench.second(0);
  bench.list(2, 1);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.counters().timeouts == 1);
  CHECK(bench.counters().orphan_parts == 1);
  CHECK(bench.counters().stamps_backwards == 1);
}

TEST_CASE("After a step back the time-out runs from the new time") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.now_us -= kTimeoutUs / 2;
  bench.first(0);
  const std::int64_t last_us = bench.now_us - 100;
  bench.expire(last_us + kTimeoutUs);
  CHECK(bench.scans.empty());
  bench.expire(last_us + kTimeoutUs + 1);
  CHECK(bench.scans.size() == 1);
}

TEST_CASE("The most extreme stamps are only far apart") {
  ScanBench bench(kWithHeader);
  bench.now_us = std::numeric_limits<std::int64_t>::min();
  bench.header(1, 1);
  bench.expire(std::numeric_limits<std::int64_t>::max());
  CHECK(bench.counters().timeouts == 1);
  bench.now_us = std::numeric_limits<std::int64_t>::max() - 100;
  bench.header(2, 1);
  bench.now_us = std::numeric_limits<std::int64_t>::min();
  bench.first(0);
  CHECK(bench.counters().timeouts == 2);
}

TEST_CASE("An offset beyond the most extreme stamps overflows nothing") {
  const PlainDecoder decoder({true, 65536, 256});
  ScanAssembler assembler(decoder, kTimeoutUs, 1'000);
  assembler.add({.kind = ScanPart::Kind::header,
                 .target_count = 1,
                 .stamp_us = std::numeric_limits<std::int64_t>::max()});
  const auto open_us = assembler.open_stamp_us();  // Under UBSan in CI.
  assembler.finish();
  CHECK(assembler.next()->stamp_us == open_us);
}

}  // namespace
}  // namespace cremed::test
