// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <string>
#include <vector>

#include "cremed/can_decoders/scan_assembler.hpp"
#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

TEST_CASE("A list is closed by its last part, the next header, or the end of input") {
  const std::vector<ScanRow> rows = {
      {"as soon as its last part is there",
       "h7/2 f40=11 f9=12 s40=21 !0 s9=22 !1",
       {"7/2 complete 40=11,21 9=12,22 @0"}},
      {"its targets are in the order of their first parts, also if these are second messages",
       "h1/2 s3=6 f4=7 s4=8 f3=5",
       {"1/2 complete 3=5,6 4=7,8"},
       {.reordered_parts = 1}},
      {"a header that announces nothing is a complete empty scan", "h7/0", {"7/0 complete"}},
      {"a scan forgets the one before it",
       "L1/3 h2/1 f2=50 s2=60",
       {"1/3 complete 0 1 2", "2/1 complete 2=50,60"}},
      {"the next header closes a scan that lacks parts",
       "h1/3 f0 f1 s1=77 L2/1",
       {"1/3 missing_parts 1=1,77", "2/1 complete 0"},
       {.missing_parts = 3}},
      {"a header can close one scan and be another",
       "h1/1 !0 h2/0 !2",
       {"1/1 missing_parts", "2/0 complete"},
       {.missing_parts = 2}},
      {"the end of input closes the open scan",
       ". !0 h1/1 f0 . .",
       {"1/1 missing_parts"},
       {.missing_parts = 1}},
      {"the header of the last scan closes the open one",
       "L1/1 h2/1 L1/1",
       {"1/1 complete 0", "2/1 missing_parts"},
       {.missing_parts = 2, .orphan_parts = 2, .repeated_scans = 1}},
  };
  check_scripts(kWithHeader, rows);
}

TEST_CASE("A list is closed when no part of it came for too long") {
  const std::vector<ScanRow> rows = {
      {"by expire(), unless a clock is set back",
       "h1/1 +40000 f0 x50000 x-500000 !0 x50001 !1 x500000",
       {"1/1 missing_parts"},
       {.timeouts = 1, .missing_parts = 1}},
      {"a later part finds its scan closed",
       "h1/1 f0 +50000 s0",
       {"1/1 missing_parts"},
       {.timeouts = 1, .missing_parts = 1, .orphan_parts = 1}},
      {"a part exactly at the time-out still counts", "h1/1 f0 +49900 s0", {"1/1 complete 0"}},
      {"a repeated header, a duplicate and an excess part are parts",
       "h1/1 +25000 h1/1 +49800 f0 +49800 f0 +49800 f1 +49800 s0",
       {"1/1 conflicting_parts 0"},
       {.duplicate_parts = 2, .excess_parts = 1}},
      {"time-out and a new empty scan in one header",
       "h1/1 +100000 !0 h2/0 !2",
       {"1/1 missing_parts", "2/0 complete"},
       {.timeouts = 1, .missing_parts = 2}},
  };
  check_scripts(kWithHeader, rows);
}

TEST_CASE("What comes again or contradicts is not taken twice") {
  const std::vector<ScanRow> rows = {
      {"a header again is a duplicate",
       "h1/1 f0 h1/1 s0",
       {"1/1 complete 0 @0"},
       {.duplicate_parts = 1}},
      {"a header again with another number is a conflict",
       "h1/1 f0 h1/2 s0",
       {"1/1 conflicting_parts 0"},
       {.conflicting_parts = 1}},
      {"the same message again is ignored",
       "h1/1 f0=5 f0=5 s0=6",
       {"1/1 complete 0=5,6"},
       {.duplicate_parts = 1}},
      {"a first message with other bytes",
       "h1/2 f0=5 f1=5 s0=6 f0=8 s1=6",
       {"1/2 conflicting_parts 0=5,6 1=5,6"},
       {.conflicting_parts = 1}},
      {"a second message with other bytes",
       "h1/2 f0=5 f1=5 s0=6 s0=9 s1=6",
       {"1/2 conflicting_parts 0=5,6 1=5,6"},
       {.conflicting_parts = 1}},
      {"more targets than announced are dropped",
       "h1/1 f0 f1 s1 s0",
       {"1/1 conflicting_parts 0"},
       {.excess_parts = 2}},
      {"a contradiction weighs more than lost frames",
       "h1/2 f0=5 d f0=6 .",
       {"1/2 conflicting_parts"},
       {.missing_parts = 3, .conflicting_parts = 1}},
      {"a damaged header in the middle of a list begins no scan",
       "L1/2 L2/2 h3/2 f0 h16387/2 f1 s0 s1 +10000 L4/2",
       {"1/2 complete 0 1", "2/2 complete 0 1", "3/2 conflicting_parts 0 1", "4/2 complete 0 1"},
       {.conflicting_parts = 1}},
  };
  check_scripts(kWithHeader, rows);
}

TEST_CASE("A repeated list never looks like a fresh one") {
  const std::vector<ScanRow> rows = {
      {"not even after a long time",
       "L1/2 +10000000 L1/2",
       {"1/2 complete 0 1"},
       {.orphan_parts = 4, .repeated_scans = 1}},
      {"nor if it announces nothing",
       "L1/2 +10000000 L1/2 h1/0",
       {"1/2 complete 0 1"},
       {.orphan_parts = 4, .repeated_scans = 2}},
      {"with a part that the last one lacked, or cut short",
       "h1/2 f0 f1 s0 +100000 L1/2 +100000 h1/2 f0 x100100",
       {"1/2 missing_parts 0"},
       {.timeouts = 1, .missing_parts = 1, .orphan_parts = 5, .repeated_scans = 2}},
      {"neither it nor an incomplete one counts as missed",
       "L1/1 L1/1 h2/5 L3/1",
       {"1/1 complete 0", "2/5 missing_parts", "3/1 complete 0"},
       {.missing_parts = 10, .orphan_parts = 2, .repeated_scans = 1}},
  };
  check_scripts(kWithHeader, rows);
}

TEST_CASE("With a counter that stands still, each list that differs from the last is a scan") {
  // Two empty lists are alike, and the first one after them has nothing to differ from.
  const std::vector<ScanRow> rows = {
      {"whatever the lists hold",
       "L7/5=1 +25000 L7/5=2 +25000 L7/3=3 +25000 L7/9=4 +25000 L7/0=5 +25000 L7/0=6 +25000 "
       "L7/4=7 +25000 L7/4=8 +25000 L7/4=9",
       {"7/5 complete 0 1 2 3 4", "7/5 complete 0=2 1=2 2=2 3=2 4=2", "7/3 complete 0=3 1=3 2=3",
        "7/9 complete 0=4 1=4 2=4 3=4 4=4 5=4 6=4 7=4 8=4", "7/4 complete 0=8 1=8 2=8 3=8",
        "7/4 complete 0=9 1=9 2=9 3=9"},
       {.orphan_parts = 8, .repeated_scans = 3}},
      {"and parts of two lists are in no complete scan",
       "L7/3=1 +25000 L7/3=2 +25000 L7/3=3 +25000 h7/3 f1-2=4 s0-2=4 +25000 L7/3=5 +25000 "
       "L7/3=6 +25000 L7/3=7 +25000 L7/3=8 +25000 L7/3=9",
       {"7/3 complete 0 1 2", "7/3 complete 0=2 1=2 2=2", "7/3 complete 0=3 1=3 2=3",
        "7/3 missing_parts 1=4 2=4", "7/3 complete 0=5 1=5 2=5", "7/3 complete 0=6 1=6 2=6",
        "7/3 complete 0=7 1=7 2=7", "7/3 complete 0=8 1=8 2=8", "7/3 complete 0=9 1=9 2=9"},
       {.missing_parts = 1, .reordered_parts = 1}}};
  check_scripts(kWithHeader, rows);
}

TEST_CASE("A list is fresh from the first part that differs from the last list") {
  ScanBench bench(kWithHeader);
  bench.play("L1/3 h1/3 f0 f1");
  CHECK(bench.open_stamp_us() == std::nullopt);
  bench.play("f2=9");
  CHECK(bench.open_stamp_us() == kBeginUs + 7 * 100);
  CHECK(bench.awaited_parts() == 3U);
  bench.play("s0-2");
  const std::vector<std::string> scans = {"1/3 complete 0 1 2", "1/3 complete 0 1 2=9,1 @700"};
  CHECK(bench.told(scans) == scans);
}

TEST_CASE("Parts without a header are orphans, or a list whose header was lost") {
  const std::string fives = "1/5 complete 0 1 2 3 4";
  const std::vector<ScanRow> rows = {
      {"no list yet", "f0 s0", {}, {.orphan_parts = 2}},
      {"the last list is whole", "f0 s0 L1/1 s0", {"1/1 complete 0"}, {.orphan_parts = 3}},
      {"no pause", "L1/5 f0=9 .", {fives}, {.orphan_parts = 1}},
      {"not the beginning", "L1/5 +60000 f4=9 .", {fives}, {.orphan_parts = 1}},
      {"second message", "L1/5 +60000 s0=9 .", {fives}, {.orphan_parts = 1}},
      {"a header that comes after its first targets is theirs",
       "L1/2 +10000 f0 h2/2 f1 s0 s1",
       {"1/2 complete 0 1", "2/2 complete 0 1"},
       {}},
      // Two counts a cycle. With its header a list lost slot 0.
      {"a list of its own, stamped by its first frame",
       "L1/5 L3/5 h5/5 f0-4 s0-4=2 +10000 f1-4=3 s0-4=4 +10000 L9/5",
       {fives, "3/5 complete 0 1 2 3 4", "5/5 complete 0=1,2 1=1,2 2=1,2 3=1,2 4=1,2",
        "7/5 missing_parts 1=3,4 2=3,4 3=3,4 4=3,4 @13300", "9/5 complete 0 1 2 3 4"},
       {.missing_parts = 1, .reordered_parts = 1, .headerless_scans = 1}},
      {"the list before it is not whole",
       "L1/5 L3/5 h5/5 f0-4 s1-4=2 +10000 f1-4=3 s0-4=4 +10000 L9/5",
       {fives, "3/5 complete 0 1 2 3 4", "5/5 missing_parts 1=1,2 2=1,2 3=1,2 4=1,2",
        "7/5 missing_parts 1=3,4 2=3,4 3=3,4 4=3,4 @13200", "9/5 complete 0 1 2 3 4"},
       {.missing_parts = 2, .reordered_parts = 1, .headerless_scans = 1}},
  };
  check_scripts(kWithHeader, rows);
}

TEST_CASE("Scans nobody takes are overwritten, oldest first") {
  const PlainDecoder decoder(kWithHeader);
  ScanAssembler assembler(decoder, kTimeoutUs);
  for (std::uint16_t counter = 1; counter <= 3; ++counter) {
    assembler.add({.kind = ScanPart::Kind::header, .counter = counter});
  }
  CHECK(assembler.next()->counter == 2);
  CHECK(assembler.next()->counter == 3);
  CHECK(assembler.next() == nullptr);
  CHECK(assembler.counters().scans == 3);
}

TEST_CASE("A radar's stamp offset is in the stamps of its scans, and nowhere else") {
  const PlainDecoder decoder({true, 65536, 256});
  for (const std::int64_t offset_us : {std::int64_t{-30'000}, std::int64_t{0}, kTimeoutUs * 3}) {
    ScanAssembler assembler(decoder, kTimeoutUs, offset_us);
    const std::int64_t stamp_us = 1'000'000;
    assembler.add({.kind = ScanPart::Kind::header, .target_count = 1, .stamp_us = stamp_us});
    CHECK(assembler.open_stamp_us() == stamp_us + offset_us);
    assembler.expire(stamp_us + kTimeoutUs);
    CHECK(assembler.next() == nullptr);
    assembler.expire(stamp_us + kTimeoutUs + 1);
    const RadarScan* scan = assembler.next();
    REQUIRE(scan != nullptr);
    CHECK(scan->stamp_us == stamp_us + offset_us);
  }
}

TEST_CASE("Frames that are no parts change nothing") {
  const PlainDecoder decoder(kWithHeader);
  ScanAssembler assembler(decoder, kTimeoutUs);
  assembler.add({.kind = ScanPart::Kind::header, .target_count = 1, .stamp_us = 1'000'000});
  assembler.add({});  // Stamp 0: neither a step back nor a time-out.
  CHECK(assembler.next() == nullptr);
  CHECK(assembler.counters().stamps_backwards == 0);
}

}  // namespace
}  // namespace cremed::test
