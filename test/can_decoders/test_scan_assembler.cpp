// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "cremed/can_decoders/scan_assembler.hpp"
#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

TEST_CASE("A list is a scan as soon as its last part is there") {
  ScanBench bench(kWithHeader);
  bench.header(7, 2);
  bench.first(40, 11);
  bench.first(9, 12);
  bench.second(40, 21);
  CHECK(bench.scans.empty());
  bench.second(9, 22);
  REQUIRE(bench.scans.size() == 1);
  const RadarScan& scan = bench.scans[0];
  CHECK(scan.status == ScanStatus::complete);
  CHECK(scan.stamp_us == 1'000'000);
  CHECK(scan.counter == 7);
  CHECK(scan.announced == 2);
  REQUIRE(scan.count == 2);
  CHECK(scan.detections[0].id == 40);
  CHECK(scan.detections[0].range_m == 11);
  CHECK(scan.detections[0].range_std_m == 21);
  CHECK(scan.detections[1].id == 9);
  CHECK(scan.detections[1].range_m == 12);
  CHECK(scan.detections[1].range_std_m == 22);
  CHECK(bench.counters().scans == 1);
  CHECK(bench.counters().incomplete_scans == 0);
  CHECK(bench.counters().empty_scans == 0);
  CHECK(bench.counters().reordered_parts == 0);
}

TEST_CASE("A header that announces nothing is a complete empty scan") {
  ScanBench bench(kWithHeader);
  bench.header(7, 0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.scans[0].count == 0);
  CHECK(bench.counters().empty_scans == 1);
}

TEST_CASE("A scan forgets the one before it") {
  ScanBench bench(kWithHeader);
  bench.list(1, 3);
  bench.header(2, 1);
  bench.first(2, 50);
  bench.second(2, 60);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.scans[1].count == 1);
  CHECK(bench.scans[1].detections[0].range_m == 50);
}

TEST_CASE("The next header closes a scan that lacks parts") {
  ScanBench bench(kWithHeader);
  bench.header(1, 3);
  bench.first(0);
  bench.first(1);
  bench.second(1, 77);
  bench.list(2, 1);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.scans[0].announced == 3);
  REQUIRE(bench.scans[0].count == 1);
  CHECK(bench.scans[0].detections[0].range_std_m == 77);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.counters().missing_parts == 3);
  CHECK(bench.counters().incomplete_scans == 1);
  CHECK(bench.counters().timeouts == 0);
}

TEST_CASE("A header can close one scan and be another") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.header(2, 0);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.most_waiting == 2);
  CHECK(bench.scans[0].counter == 1);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.scans[1].counter == 2);
  CHECK(bench.scans[1].status == ScanStatus::complete);
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

TEST_CASE("The end of input closes the open scan") {
  ScanBench bench(kWithHeader);
  bench.finish();
  CHECK(bench.scans.empty());
  bench.header(1, 1);
  bench.first(0);
  bench.finish();
  bench.finish();
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.counters().missing_parts == 1);
}

TEST_CASE("An open scan expires when no part of it came for too long") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.now_us += 40'000;
  bench.first(0);
  const std::int64_t last_us = bench.now_us - 100;
  bench.expire(last_us + kTimeoutUs);
  CHECK(bench.scans.empty());
  bench.expire(last_us - 10 * kTimeoutUs);  // A clock set back.
  CHECK(bench.scans.empty());
  bench.expire(last_us + kTimeoutUs + 1);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.counters().timeouts == 1);
  bench.expire(last_us + 10 * kTimeoutUs);
  CHECK(bench.scans.size() == 1);
}

TEST_CASE("A part that comes after the time-out finds its scan closed") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.first(0);
  bench.now_us += kTimeoutUs;  // With the 100 us since the last part just over the time-out.
  bench.second(0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.counters().timeouts == 1);
  CHECK(bench.counters().orphan_parts == 1);
}

TEST_CASE("A part exactly at the time-out still counts") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.first(0);
  bench.now_us += kTimeoutUs - 100;
  bench.second(0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
}

TEST_CASE("Time-out and a new empty scan in one header") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.now_us += 2 * kTimeoutUs;
  bench.header(2, 0);
  CHECK(bench.most_waiting == 2);
  CHECK(bench.counters().timeouts == 1);
  CHECK(bench.counters().empty_scans == 1);
}

TEST_CASE("A header again is a duplicate") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.first(0);
  bench.header(1, 1);
  bench.second(0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.scans[0].stamp_us == 1'000'000);
  CHECK(bench.counters().duplicate_parts == 1);
  CHECK(bench.counters().conflicting_parts == 0);
}

TEST_CASE("A header again with another number is a conflict") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.first(0);
  bench.header(1, 2);
  bench.second(0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::conflicting_parts);
  CHECK(bench.scans[0].announced == 1);
  CHECK(bench.scans[0].count == 1);
  CHECK(bench.counters().conflicting_parts == 1);
  CHECK(bench.counters().duplicate_parts == 0);
}

TEST_CASE("A repeated list never looks like a fresh one") {
  ScanBench bench(kWithHeader);
  bench.list(1, 2);
  bench.now_us += 10'000'000;  // Not even after a long time.
  bench.list(1, 2);
  CHECK(bench.scans.size() == 1);
  CHECK(bench.counters().repeated_scans == 1);
  CHECK(bench.counters().orphan_parts == 4);
  bench.header(1, 0);
  CHECK(bench.scans.size() == 1);
  CHECK(bench.counters().repeated_scans == 2);
}

TEST_CASE("A counter that stands still loses no list, whatever the lists hold") {
  ScanBench bench(kWithHeader);
  const std::vector<std::uint16_t> counts = {5, 5, 3, 9, 0, 0, 4, 4, 4};
  for (std::size_t i = 0; i < counts.size(); ++i) {
    bench.now_us += kTimeoutUs / 2;
    bench.list(7, counts[i], static_cast<std::uint8_t>(i + 1));
  }
  // Two empty lists are alike, and the first one after them has nothing to differ from.
  const std::vector<std::size_t> fresh = {0, 1, 2, 3, 7, 8};
  REQUIRE(bench.scans.size() == fresh.size());
  for (std::size_t i = 0; i < fresh.size(); ++i) {
    CAPTURE(i);
    CHECK(bench.scans[i].status == ScanStatus::complete);
    REQUIRE(bench.scans[i].count == counts[fresh[i]]);
    CHECK(bench.scans[i].detections[0].range_m == static_cast<double>(fresh[i] + 1));
    CHECK(bench.scans[i].detections[0].range_std_m == static_cast<double>(fresh[i] + 1));
  }
  CHECK(bench.counters().repeated_scans == 3);
  CHECK(bench.counters().missed_scans == 0);
}

TEST_CASE("A list is fresh from the first part that differs from the last list") {
  ScanBench bench(kWithHeader);
  bench.list(1, 3);
  bench.header(1, 3);
  bench.first(0);
  bench.first(1);
  CHECK(bench.open_stamp_us() == std::nullopt);
  bench.first(2, 9);
  CHECK(bench.open_stamp_us() == 1'000'000 + 7 * 100);
  CHECK(bench.awaited_parts() == 3U);
  for (std::uint8_t slot = 0; slot < 3; ++slot) {
    bench.second(slot);
  }
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.scans[1].count == 3);
  CHECK(bench.scans[1].stamp_us == 1'000'000 + 7 * 100);
}

TEST_CASE("A repeated list with a part that the last one lacked, or cut short, is no scan") {
  ScanBench bench(kWithHeader);
  bench.header(1, 2);
  bench.first(0);
  bench.first(1);
  bench.second(0);
  bench.now_us += 2 * kTimeoutUs;
  bench.list(1, 2);
  bench.now_us += 2 * kTimeoutUs;
  bench.header(1, 2);
  bench.first(0);
  bench.expire(bench.now_us + 2 * kTimeoutUs);
  CHECK(bench.scans.size() == 1);
  CHECK(bench.counters().timeouts == 1);
  CHECK(bench.counters().repeated_scans == 2);
  CHECK(bench.counters().orphan_parts == 5);
}

TEST_CASE("With a counter that stands still, parts of two lists are in no complete scan") {
  ScanBench bench(kWithHeader);
  for (std::uint8_t value = 1; value <= 9; ++value) {
    bench.now_us += kTimeoutUs / 2;
    bench.header(7, 3);
    for (std::uint8_t slot = value == 4 ? 1 : 0; slot < 3; ++slot) {
      bench.first(slot, value);
    }
    for (std::uint8_t slot = 0; slot < 3; ++slot) {
      bench.second(slot, value);
    }
  }
  REQUIRE(bench.scans.size() == 9);
  for (std::size_t i = 0; i < bench.scans.size(); ++i) {
    CAPTURE(i);
    CHECK(bench.scans[i].status == (i == 3 ? ScanStatus::missing_parts : ScanStatus::complete));
    CHECK(bench.scans[i].detections[0].range_std_m == static_cast<double>(i + 1));
  }
}

TEST_CASE("The header of the last scan closes the open one") {
  ScanBench bench(kWithHeader);
  bench.list(1, 1);
  bench.header(2, 1);
  bench.list(1, 1);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[1].counter == 2);
  CHECK(bench.scans[1].status == ScanStatus::missing_parts);
  CHECK(bench.scans[1].count == 0);
  CHECK(bench.counters().repeated_scans == 1);
  CHECK(bench.counters().orphan_parts == 2);
}

TEST_CASE("The same message again is ignored") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.first(0, 5);
  bench.first(0, 5);
  bench.second(0, 6);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.scans[0].count == 1);
  CHECK(bench.counters().duplicate_parts == 1);
}

TEST_CASE("The same message with other bytes makes a scan conflicting") {
  for (const bool of_first : {true, false}) {
    ScanBench bench(kWithHeader);
    bench.header(1, 2);
    bench.first(0, 5);
    bench.first(1, 5);
    bench.second(0, 6);
    of_first ? bench.first(0, 8) : bench.second(0, 9);
    bench.second(1, 6);
    REQUIRE(bench.scans.size() == 1);
    CHECK(bench.scans[0].status == ScanStatus::conflicting_parts);
    CHECK(bench.scans[0].count == 2);
    CHECK(bench.scans[0].detections[0].range_m == 5);
    CHECK(bench.scans[0].detections[0].range_std_m == 6);
    CHECK(bench.counters().conflicting_parts == 1);
    CHECK(bench.counters().incomplete_scans == 1);
    CHECK(bench.counters().missing_parts == 0);
  }
}

TEST_CASE("The second message may come before the first") {
  ScanBench bench(kWithHeader);
  bench.header(1, 2);
  bench.second(3, 6);
  bench.first(4, 7);
  bench.second(4, 8);
  bench.first(3, 5);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  REQUIRE(bench.scans[0].count == 2);
  CHECK(bench.scans[0].detections[0].id == 3);  // In order of the message that came first.
  CHECK(bench.scans[0].detections[0].range_m == 5);
  CHECK(bench.scans[0].detections[0].range_std_m == 6);
  CHECK(bench.counters().reordered_parts == 1);
}

TEST_CASE("More targets than announced are dropped and the scan is not whole") {
  ScanBench bench(kWithHeader);
  bench.header(1, 1);
  bench.first(0);
  bench.first(1);
  bench.second(1);
  bench.second(0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::conflicting_parts);
  REQUIRE(bench.scans[0].count == 1);
  CHECK(bench.scans[0].detections[0].id == 0);
  CHECK(bench.counters().excess_parts == 2);
}

TEST_CASE("Parts without an open scan are orphans") {
  ScanBench bench(kWithHeader);
  bench.first(0);
  bench.second(0);
  CHECK(bench.counters().orphan_parts == 2);
  bench.list(1, 1);
  bench.second(0);
  CHECK(bench.counters().orphan_parts == 3);
  CHECK(bench.scans.size() == 1);
}

TEST_CASE("A list whose header was lost is a scan of its own, stamped by its first frame") {
  const bool is_last_whole = GENERATE(true, false);
  CAPTURE(is_last_whole);
  ScanBench bench(kWithHeader);
  bench.list(1, 5);
  bench.list(3, 5);  // Two counts a cycle.
  bench.header(5, 5);
  for (std::uint8_t slot = 0; slot < 5; ++slot) {
    bench.first(slot, 1);
  }
  for (std::uint8_t slot = is_last_whole ? 0 : 1; slot < 5; ++slot) {
    bench.second(slot, 2);
  }
  bench.now_us += 10'000;
  const std::int64_t begin_us = bench.now_us;
  for (std::uint8_t slot = 1; slot < 5; ++slot) {  // With the header slot 0 was lost.
    bench.first(slot, 3);
  }
  for (std::uint8_t slot = 0; slot < 5; ++slot) {
    bench.second(slot, 4);
  }
  bench.now_us += 10'000;
  bench.list(9, 5);
  REQUIRE(bench.scans.size() == 5);
  const RadarScan& scan = bench.scans[3];
  CHECK(scan.status == ScanStatus::missing_parts);
  CHECK(scan.stamp_us == begin_us);
  CHECK(scan.counter == 7);
  CHECK(scan.announced == 5);
  REQUIRE(scan.count == 4);
  CHECK(scan.detections[0].id == 1);
  CHECK(scan.detections[0].range_m == 3);
  CHECK(bench.scans[2].count == (is_last_whole ? 5 : 4));
  CHECK(bench.scans[4].status == ScanStatus::complete);
  CHECK(bench.counters().headerless_scans == 1);
  CHECK(bench.counters().orphan_parts == 0);
  CHECK(bench.counters().conflicting_parts == 0);
  CHECK(bench.counters().missed_scans == 0);
}

TEST_CASE("What may be the rest of an old list begins no scan") {
  struct Row {
    const char* what;
    std::int64_t pause_us;
    std::uint8_t slot;
    bool is_first;
  };
  const auto row = GENERATE(Row{"no pause", 0, 0, true}, Row{"not the beginning", 60'000, 4, true},
                            Row{"second message", 60'000, 0, false});
  CAPTURE(row.what);
  ScanBench bench(kWithHeader);
  bench.list(1, 5);
  bench.now_us += row.pause_us;
  row.is_first ? bench.first(row.slot, 9) : bench.second(row.slot, 9);
  bench.finish();
  CHECK(bench.scans.size() == 1);
  CHECK(bench.counters().orphan_parts == 1);
}

TEST_CASE("A header that comes after its first targets is theirs") {
  ScanBench bench(kWithHeader);
  bench.list(1, 2);
  bench.now_us += 10'000;
  bench.first(0);
  bench.header(2, 2);
  bench.first(1);
  bench.second(0);
  bench.second(1);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[1].status == ScanStatus::complete);
  CHECK(bench.scans[1].counter == 2);
  CHECK(bench.counters().headerless_scans == 0);
}

TEST_CASE("A damaged header in the middle of a list begins no scan") {
  ScanBench bench(kWithHeader);
  bench.list(1, 2);
  bench.list(2, 2);
  bench.header(3, 2);
  bench.first(0);
  bench.header(3 | 1 << 14, 2);
  bench.first(1);
  bench.second(0);
  bench.second(1);
  REQUIRE(bench.scans.size() == 3);
  CHECK(bench.scans[2].status == ScanStatus::conflicting_parts);
  CHECK(bench.scans[2].counter == 3);
  bench.now_us += 10'000;
  bench.list(4, 2);
  CHECK(bench.scans.back().status == ScanStatus::complete);
}

TEST_CASE("A contradiction weighs more than lost frames") {
  ScanBench bench(kWithHeader);
  bench.header(1, 2);
  bench.first(0, 5);
  bench.mark_dropped();
  bench.first(0, 6);
  bench.finish();
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::conflicting_parts);
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
