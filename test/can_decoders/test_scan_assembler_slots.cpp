// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <optional>
#include <string>
#include <vector>

#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

// Without header; four slots are enough to see everything.
const ScanFraming kSlots{false, 4, 4, 2};

TEST_CASE("All messages of all slots are a scan") {
  const std::vector<ScanRow> rows = {
      {"as soon as the last one is there",
       "c3 b0-2 f3=50 !0 s3=60",
       {"3/4 complete 0 1 2 3=50,60 @0"}},
      {"empty slots belong to it but are not stored in it",
       "f0=255 s0 f1=255 s1 f2=7 s2 f3=255 s3",
       {"0/4 complete 2=7,1"}},
      {"only empty slots are an empty scan",
       "f0=255 s0 f1=255 s1 f2=255 s2 f3=255 s3",
       {"0/4 complete"}},
      {"a new counter closes a scan that lacks parts",
       "c1 b0-2 c2 b0-3",
       {"1/4 missing_parts 0 1 2", "2/4 complete 0 1 2 3"},
       {.missing_parts = 2}},
      {"silence closes a scan",
       "c1 b0-2 x50100",
       {"1/4 missing_parts 0 1 2"},
       {.timeouts = 1, .missing_parts = 2}},
      {"cut by a pause they are two that lack parts",
       "c1 b0-1 +100000 b2-3 .",
       {"1/4 missing_parts 0 1", "1/4 missing_parts 2 3"},
       {.timeouts = 1, .missing_parts = 8}},
      {"duplicates, conflicts and lost frames",
       "c1 f0 f0 s0 b1-3 c2 f0 f0=2 s0 b1-3 c3 f0 d s0 b1-3",
       {"1/4 complete 0 1 2 3", "2/4 conflicting_parts 0 1 2 3", "3/4 dropped_frames 0 1 2 3"},
       {.duplicate_parts = 1, .conflicting_parts = 1}},
      {"a slot the radar does not have is excess",
       "c1 b0-2 f3 f4 s3",
       {"1/4 conflicting_parts 0 1 2 3"},
       {.excess_parts = 1}},
  };
  check_scripts(kSlots, rows);
}

TEST_CASE("The counter of the last scan is that scan again, or a new one") {
  const std::string first = "1/4 complete 0 1 2 3";
  const std::vector<ScanRow> rows = {
      // Each echo is within the time-out of the part before it.
      {"late parts open no stale one",
       "c1 b0-3 +49000 b0-3 +49000 b0-3 +49000 b0-3 .",
       {first},
       {.orphan_parts = 24, .repeated_scans = 3}},
      {"a late part does not disturb the scan that has begun",
       "c1 b0-3 c2 b0-1 c1 f0=9 c2 b2-3",
       {first, "2/4 complete 0 1 2 3"},
       {.orphan_parts = 1}},
      // Four cycles on: three are missing between.
      {"after a pause it is a new scan",
       "c0 b0-3 c1 b0-3 +50000 b0-3",
       {"0/4 complete 0 1 2 3", first, first},
       {.missed_scans = 3}},
      {"after a big step back it is a new scan",
       "c1 b0-3 -3600000000 b0-3",
       {first, first},
       {.stamps_backwards = 1}},
  };
  check_scripts(kSlots, rows);
}

TEST_CASE("A two-bit counter wraps without a gap and shows gaps") {
  struct Row {
    std::vector<std::uint16_t> counters;
    std::uint64_t missed;
  };
  for (const Row& row :
       {Row{{2, 3, 0, 1}, 0}, Row{{0, 1, 3}, 1}, Row{{0, 1, 0}, 2}, Row{{2, 3, 1}, 1}}) {
    ScanBench bench(kSlots);
    for (const std::uint16_t counter : row.counters) {
      bench.play("c" + std::to_string(counter) + " b0-3 +100000");
    }
    CAPTURE(row.counters);
    CHECK(bench.scans.size() == row.counters.size());
    CHECK(bench.counters().missed_scans == row.missed);
  }
}

/// The scan of a burst with counter 1 whose slots all have this value.
std::string whole(int value) {
  const std::string v = "=" + std::to_string(value);
  return "1/4 complete 0" + v + " 1" + v + " 2" + v + " 3" + v;
}

TEST_CASE("A counter that stands still loses no burst, however short the pauses") {
  ScanBench bench(kSlots);
  bench.play("c0 b0-3 c1");
  std::vector<std::string> scans = {"0/4 complete 0 1 2 3"};
  for (int value = 2; value <= 20; ++value) {
    bench.play("+25000 b0-3=" + std::to_string(value));
    scans.push_back(whole(value));
  }
  CHECK(bench.told(scans) == scans);
  CHECK(bench.counters() == AssemblerCounters{.scans = 20});
}

TEST_CASE("With a counter that stands still, parts of two bursts are in no complete scan") {
  const std::string begin = "c1 b0-3=9 +25000 b0-3=2 +25000 b0-3=3 +25000 ";
  const std::string end = " +25000 b0-3=5 +25000 b0-3=6 +25000 b0-3=7 +25000 b0-3=8 +25000 b0-3=9";
  const auto scans = [](const std::string& fourth) {
    return std::vector<std::string>{whole(9), whole(2), whole(3), fourth,  whole(5),
                                    whole(6), whole(7), whole(8), whole(9)};
  };
  check_scripts(kSlots, {{"the first is lost",
                          begin + "s0=4 b1-3=4" + end,
                          scans("1/4 missing_parts 1=4 2=4 3=4"),
                          {.missing_parts = 1, .reordered_parts = 1}},
                         {"another is lost",
                          begin + "b0-1=4 s2=4 b3=4" + end,
                          scans("1/4 missing_parts 0=4 1=4 3=4"),
                          {.missing_parts = 1, .reordered_parts = 1}}});
}

TEST_CASE("A late part of the last burst delays and spoils nothing of the next") {
  const std::string next = GENERATE("1", "2");  // Also if the counter stands still.
  CAPTURE(next);
  ScanBench bench(kSlots);
  bench.play("c1 b0-3 s3");
  CHECK(bench.open_stamp_us() == std::nullopt);
  CHECK(bench.awaited_parts() == std::nullopt);
  bench.play("+25000 c" + next + " b0-3=2");
  const std::vector<std::string> scans = {"1/4 complete 0 1 2 3",
                                          next + "/4 complete 0=2 1=2 2=2 3=2 @25900"};
  CHECK(bench.told(scans) == scans);
  CHECK(
      bench.counters() ==
      AssemblerCounters{.scans = 2, .reordered_parts = 1, .orphan_parts = 1, .repeated_scans = 1});
}

}  // namespace
}  // namespace cremed::test
