// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <string>
#include <vector>

#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

TEST_CASE("256 targets fit") {
  for (const unsigned announced : {256U, 300U}) {
    CAPTURE(announced);
    ScanBench bench(kWithHeader);
    bench.play("h1/" + std::to_string(announced) + " b0-255");
    REQUIRE(bench.scans.size() == 1);
    const RadarScan& scan = bench.scans[0];
    CHECK(scan.status == (announced == 256 ? ScanStatus::complete : ScanStatus::over_capacity));
    CHECK(scan.announced == announced);
    CHECK(scan.count == 256);
    CHECK(scan.detections[255].id == 255);
    CHECK(bench.counters().missing_parts == 2 * (announced - 256));
  }
}

TEST_CASE("The status is the first that applies") {
  const std::vector<ScanRow> rows = {
      {"over capacity hides conflicts and missing parts",
       "h1/257 f0 f0=2 .",
       {"1/257 over_capacity"},
       {.missing_parts = 513, .conflicting_parts = 1}},
      {"a conflict hides missing parts",
       "h1/2 f0 f0=2 .",
       {"1/2 conflicting_parts"},
       {.missing_parts = 3, .conflicting_parts = 1}},
      {"lost frames spoil the open scan", "h1/1 f0 d s0 .", {"1/1 dropped_frames 0"}},
      {"lost frames hide no conflict",
       "h1/1 f0 d f0=9 s0 .",
       {"1/1 conflicting_parts 0"},
       {.conflicting_parts = 1}},
      {"nor that they are too many",
       "h1/300 f0 d s0 .",
       {"1/300 over_capacity 0"},
       {.missing_parts = 598}},
      {"nor both",
       "h1/300 f0 d f0=9 s0 .",
       {"1/300 over_capacity 0"},
       {.missing_parts = 598, .conflicting_parts = 1}},
      {"lost frames between scans spoil none",
       "d L1/1 d L2/1",
       {"1/1 complete 0", "2/1 complete 0"}},
  };
  check_scripts(kWithHeader, rows);
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
    for (const std::uint16_t counter : row.counters) {  // With time enough for any gap.
      bench.play("+3600000000 L" + std::to_string(counter) + "/1");
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
    bench.play("L39998/1 +75000 L40000/1 +75000 +" + std::to_string(row.pause_us));
    bench.play("L0/1 +200000 L2/1 +200000 L8/1");  // Two are missing.
    CHECK(bench.counters().missed_scans == row.missed + 2);
  }
}

TEST_CASE("A first step that was a glitch is forgotten") {
  ScanBench bench(kWithHeader);
  bench.play("L1/1");
  std::uint64_t missed_at_first = 0;
  for (int counter = 2; counter < 82; counter += 2) {
    bench.play("+75000 L" + std::to_string(counter) + "/1");
    missed_at_first = counter <= 40 ? bench.counters().missed_scans : missed_at_first;
  }
  CHECK(missed_at_first < 20);
  CHECK(bench.counters().missed_scans == missed_at_first);
}

TEST_CASE("Stamps may run backwards") {
  const std::vector<ScanRow> rows = {
      {"equal stamps are no step back", "h1/1 -100 f0", {}},
      {"a small step back is counted and harmless",
       "h1/1 -25000 f0 s0",
       {"1/1 complete 0"},
       {.stamps_backwards = 1}},
      {"beyond the time-out it closes the open scan",
       "h1/1 f0 -3600000000 s0 L2/1",
       {"1/1 missing_parts", "2/1 complete 0"},
       {.timeouts = 1, .missing_parts = 1, .orphan_parts = 1, .stamps_backwards = 1}},
      {"the time-out runs from the new time",
       "h1/1 -25000 f0 x50000 !0 x50001 !1",
       {"1/1 missing_parts"},
       {.timeouts = 1, .missing_parts = 1, .stamps_backwards = 1}},
  };
  check_scripts(kWithHeader, rows);
}

TEST_CASE("The most extreme stamps are only far apart") {
  ScanBench bench(kWithHeader);
  bench.now_us = std::numeric_limits<std::int64_t>::min();
  bench.play("h1/1");
  bench.expire(std::numeric_limits<std::int64_t>::max());
  CHECK(bench.counters().timeouts == 1);
  bench.now_us = std::numeric_limits<std::int64_t>::max() - 100;
  bench.play("h2/1");
  bench.now_us = std::numeric_limits<std::int64_t>::min();
  bench.play("f0");
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
