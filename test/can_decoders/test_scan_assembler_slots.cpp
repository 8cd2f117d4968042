// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

// Without header; four slots are enough to see everything.
const ScanFraming kSlots{false, 4, 4, 2};

void burst(ScanBench& bench, std::uint16_t counter, std::uint8_t from = 0, std::uint8_t to = 4) {
  for (std::uint8_t slot = from; slot < to; ++slot) {
    bench.first(slot, 1, counter);
    bench.second(slot, 1, counter);
  }
}

TEST_CASE("All messages of all slots are a scan") {
  ScanBench bench(kSlots);
  burst(bench, 3, 0, 3);
  bench.first(3, 50, 3);
  CHECK(bench.scans.empty());
  bench.second(3, 60, 3);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.scans[0].stamp_us == 1'000'000);
  CHECK(bench.scans[0].counter == 3);
  CHECK(bench.scans[0].announced == 4);
  CHECK(bench.scans[0].count == 4);
  CHECK(bench.scans[0].detections[3].range_m == 50);
  CHECK(bench.scans[0].detections[3].range_std_m == 60);
}

TEST_CASE("Empty slots belong to a scan but are not stored in it") {
  ScanBench bench(kSlots);
  for (std::uint8_t slot = 0; slot < 4; ++slot) {
    bench.first(slot, slot == 2 ? 7 : 255);
    bench.second(slot);
  }
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  REQUIRE(bench.scans[0].count == 1);
  CHECK(bench.scans[0].detections[0].id == 2);
  CHECK(bench.counters().empty_scans == 0);
}

TEST_CASE("Only empty slots are an empty scan") {
  ScanBench bench(kSlots);
  for (std::uint8_t slot = 0; slot < 4; ++slot) {
    bench.first(slot, 255);
    bench.second(slot);
  }
  CHECK(bench.scans.at(0).status == ScanStatus::complete);
  CHECK(bench.counters().empty_scans == 1);
}

TEST_CASE("A new counter closes a scan that lacks parts") {
  ScanBench bench(kSlots);
  burst(bench, 1, 0, 3);
  burst(bench, 2);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.scans[0].count == 3);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.scans[1].counter == 2);
  CHECK(bench.counters().missing_parts == 2);
}

TEST_CASE("Silence closes a scan") {
  ScanBench bench(kSlots);
  burst(bench, 1, 0, 3);
  bench.expire(bench.now_us + kTimeoutUs);
  CHECK(bench.scans.at(0).status == ScanStatus::missing_parts);
  CHECK(bench.counters().timeouts == 1);
}

TEST_CASE("Late parts of the last scan open no stale one") {
  ScanBench bench(kSlots);
  burst(bench, 1);
  // Each echo is within the time-out of the part before it.
  for (int echo = 0; echo < 3; ++echo) {
    bench.now_us += kTimeoutUs - 1'000;
    burst(bench, 1);
  }
  bench.finish();
  CHECK(bench.scans.size() == 1);
  CHECK(bench.counters().orphan_parts == 24);
  CHECK(bench.counters().missed_scans == 0);
}

TEST_CASE("A late part does not disturb the scan that has begun") {
  ScanBench bench(kSlots);
  burst(bench, 1);
  burst(bench, 2, 0, 2);
  bench.first(0, 9, 1);
  burst(bench, 2, 2, 4);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.counters().orphan_parts == 1);
  CHECK(bench.counters().conflicting_parts == 0);
}

TEST_CASE("The counter of the last scan after a pause is a new scan") {
  ScanBench bench(kSlots);
  burst(bench, 0);
  burst(bench, 1);
  bench.now_us += kTimeoutUs;
  burst(bench, 1);
  REQUIRE(bench.scans.size() == 3);
  CHECK(bench.scans[2].status == ScanStatus::complete);
  CHECK(bench.counters().orphan_parts == 0);
  CHECK(bench.counters().missed_scans == 3);  // Four cycles on: three are missing between.
}

TEST_CASE("A scan cut by a pause is two that lack parts") {
  ScanBench bench(kSlots);
  burst(bench, 1, 0, 2);
  bench.now_us += 2 * kTimeoutUs;
  burst(bench, 1, 2, 4);
  bench.finish();
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.scans[1].status == ScanStatus::missing_parts);
  CHECK(bench.counters().missing_parts == 8);
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
      burst(bench, counter);
      bench.now_us += 2 * kTimeoutUs;
    }
    CAPTURE(row.counters);
    CHECK(bench.scans.size() == row.counters.size());
    CHECK(bench.counters().missed_scans == row.missed);
  }
}

TEST_CASE("Duplicates, conflicts and lost frames of slots") {
  ScanBench bench(kSlots);
  bench.first(0, 1, 1);
  bench.first(0, 1, 1);
  bench.second(0, 1, 1);
  burst(bench, 1, 1, 4);
  CHECK(bench.scans.at(0).status == ScanStatus::complete);
  CHECK(bench.counters().duplicate_parts == 1);

  bench.first(0, 1, 2);
  bench.first(0, 2, 2);
  bench.second(0, 1, 2);
  burst(bench, 2, 1, 4);
  CHECK(bench.scans.at(1).status == ScanStatus::conflicting_parts);

  bench.first(0, 1, 3);
  bench.mark_dropped();
  bench.second(0, 1, 3);
  burst(bench, 3, 1, 4);
  CHECK(bench.scans.at(2).status == ScanStatus::dropped_frames);
}

TEST_CASE("A slot the radar does not have is excess") {
  ScanBench bench(kSlots);
  burst(bench, 1, 0, 3);
  bench.first(3, 1, 1);
  bench.first(4, 1, 1);
  bench.second(3, 1, 1);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::conflicting_parts);
  CHECK(bench.scans[0].count == 4);
  CHECK(bench.counters().excess_parts == 1);
}

TEST_CASE("A big step back opens a new scan, even of the last counter") {
  ScanBench bench(kSlots);
  burst(bench, 1);
  bench.now_us -= 3'600'000'000;
  burst(bench, 1);
  CHECK(bench.scans.size() == 2);
  CHECK(bench.counters().stamps_backwards == 1);
}

/// A burst whose slots all have `value`.
void burst_of(ScanBench& bench, std::uint16_t counter, std::uint8_t value, std::uint8_t from = 0) {
  for (std::uint8_t slot = from; slot < 4; ++slot) {
    bench.first(slot, value, counter);
    bench.second(slot, value, counter);
  }
}

TEST_CASE("A counter that stands still loses no burst, however short the pauses") {
  ScanBench bench(kSlots);
  burst_of(bench, 0, 1);
  for (std::uint8_t value = 2; value <= 20; ++value) {
    bench.now_us += kTimeoutUs / 2;
    burst_of(bench, 1, value);
  }
  REQUIRE(bench.scans.size() == 20);
  for (std::size_t i = 0; i < bench.scans.size(); ++i) {
    CAPTURE(i);
    CHECK(bench.scans[i].status == ScanStatus::complete);
    CHECK(bench.scans[i].detections[0].range_m == static_cast<double>(i + 1));
    CHECK(bench.scans[i].detections[3].range_std_m == static_cast<double>(i + 1));
  }
  CHECK(bench.counters().missed_scans == 0);
  CHECK(bench.counters().orphan_parts == 0);
}

TEST_CASE("With a counter that stands still, parts of two bursts are in no complete scan") {
  const std::uint8_t lost = GENERATE(std::uint8_t{0}, std::uint8_t{2});
  CAPTURE(lost);
  ScanBench bench(kSlots);
  burst_of(bench, 1, 1);
  for (std::uint8_t value = 2; value <= 9; ++value) {
    bench.now_us += kTimeoutUs / 2;
    for (std::uint8_t slot = 0; slot < 4; ++slot) {
      if (value != 4 || slot != lost) {
        bench.first(slot, value, 1);
      }
      bench.second(slot, value, 1);
    }
  }
  REQUIRE(bench.scans.size() == 9);
  for (std::size_t i = 0; i < bench.scans.size(); ++i) {
    CAPTURE(i);
    CHECK(bench.scans[i].status == (i == 3 ? ScanStatus::missing_parts : ScanStatus::complete));
    const RadarScan& scan = bench.scans[i];
    CHECK(scan.detections[scan.count - 1].range_m == static_cast<double>(i + 1));
  }
}

TEST_CASE("A late part of the last burst delays and spoils nothing of the next") {
  const std::uint16_t next = GENERATE(std::uint16_t{1}, std::uint16_t{2});  // Also stands still.
  CAPTURE(next);
  ScanBench bench(kSlots);
  burst_of(bench, 1, 1);
  bench.second(3, 1, 1);
  CHECK(bench.open_stamp_us() == std::nullopt);
  CHECK(bench.awaited_parts() == std::nullopt);
  bench.now_us += kTimeoutUs / 2;
  const std::int64_t begin_us = bench.now_us;
  burst_of(bench, next, 2);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.scans[1].stamp_us == begin_us);
  CHECK(bench.counters().orphan_parts == 1);
}

}  // namespace
}  // namespace cremed::test
