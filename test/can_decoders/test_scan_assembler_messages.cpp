// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Families with one message, or more than two, per target.
#include <initializer_list>

#include "test/can_decoders/scan_bench.hpp"

namespace cremed::test {
namespace {

using Numbers = std::initializer_list<std::uint8_t>;

TEST_CASE("One message is a whole target") {
  ScanBench bench({.has_header = true, .messages = 1});
  bench.header(7, 3);
  bench.first(2, 12);
  bench.first(0, 10);
  CHECK(bench.scans.empty());
  bench.first(1, 11);
  REQUIRE(bench.scans.size() == 1);
  const RadarScan& scan = bench.scans[0];
  CHECK(scan.status == ScanStatus::complete);
  REQUIRE(scan.count == 3);
  CHECK(scan.detections[0].range_m == 12.0);
  CHECK(scan.detections[2].range_m == 11.0);
  CHECK(bench.counters().reordered_parts == 0);
}

TEST_CASE("A lost target of one message is one missing part") {
  ScanBench bench({.has_header = true, .messages = 1});
  bench.header(1, 2);
  bench.first(0);
  bench.header(2, 0);
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[0].status == ScanStatus::missing_parts);
  CHECK(bench.scans[0].count == 1);
  CHECK(bench.counters().missing_parts == 1);
}

TEST_CASE("Targets of one message need no header") {
  ScanBench bench({.has_header = false, .counter_modulus = 4, .slot_count = 2, .messages = 1});
  bench.first(0, 1, 3);
  bench.first(1, 1, 3);
  bench.first(0, 1, 0);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  CHECK(bench.scans[0].counter == 3);
}

TEST_CASE("A lost header of targets of one message does not lose the scan") {
  ScanBench bench({.has_header = true, .messages = 1});
  bench.list(1, 0);
  bench.now_us += 70'000;
  bench.first(1, 5);
  bench.first(2, 6);
  bench.finish();
  REQUIRE(bench.scans.size() == 2);
  CHECK(bench.scans[1].status == ScanStatus::missing_parts);
  CHECK(bench.scans[1].counter == 2);
  CHECK(bench.scans[1].count == 2);
  CHECK(bench.counters().headerless_scans == 1);
}

TEST_CASE("Four messages make a target, in any order") {
  ScanBench bench({.has_header = true, .messages = 4});
  bench.header(1, 2);
  for (const std::uint8_t number : Numbers{0, 2, 1, 3}) {
    bench.message(number, 9, static_cast<std::uint8_t>(20 + number));
  }
  CHECK(bench.counters().reordered_parts == 1);
  bench.message(2, 9, 22);
  CHECK(bench.counters().duplicate_parts == 1);
  for (const std::uint8_t number : Numbers{0, 1, 2}) {
    bench.message(number, 4);
  }
  CHECK(bench.scans.empty());
  bench.message(3, 4);
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].status == ScanStatus::complete);
  REQUIRE(bench.scans[0].count == 2);
  CHECK(bench.scans[0].detections[0].range_m == 20.0);
  CHECK(bench.scans[0].detections[0].range_std_m == 23.0);
}

TEST_CASE("What is missing is counted by the messages of a target") {
  ScanBench bench({.has_header = true, .messages = 3});
  bench.header(1, 2);
  bench.message(0, 0);
  bench.message(1, 0);
  bench.finish();
  REQUIRE(bench.scans.size() == 1);
  CHECK(bench.scans[0].count == 0);
  CHECK(bench.counters().missing_parts == 4);
}

TEST_CASE("A message that targets of the family do not have is ignored") {
  ScanBench bench({.has_header = true, .messages = 1});
  bench.header(1, 1);
  bench.second(0);
  bench.message(255, 0);
  CHECK(bench.scans.empty());
  bench.first(0);
  CHECK(bench.scans.size() == 1);
}

TEST_CASE("More messages than fit are as many as fit") {
  ScanBench bench({.has_header = true, .messages = 200});
  bench.header(1, 1);
  for (std::uint8_t number = 0; number < kMaxMessages; ++number) {
    bench.message(number, 0);
  }
  CHECK(bench.scans.size() == 1);
}

}  // namespace
}  // namespace cremed::test
