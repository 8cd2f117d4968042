// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>

#include <catch2/catch.hpp>

#include "daemon/bus_clocks.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kStartUs = 1'700'000'000'000'000;

CanFrame frame_of(std::uint8_t interface, std::int64_t stamp_us) {
  CanFrame frame;
  frame.interface = interface;
  frame.stamp_us = stamp_us;
  return frame;
}

TEST_CASE("frames in order or reordered by some milliseconds are no clock that was set back") {
  BusClocks clocks;
  for (std::int64_t i = 0; i < 1000; ++i) {
    const std::int64_t stamp_us = kStartUs + 250 * i - (i % 50 == 49 ? 5'000 : 0);
    CHECK_FALSE(clocks.is_set_back(frame_of(static_cast<std::uint8_t>(i % 3), stamp_us)));
  }
  CHECK_FALSE(clocks.is_set_back(frame_of(1, kStartUs + 100'000)));
  CHECK_FALSE(clocks.is_set_back(frame_of(1, kStartUs + 100'250)));
  CHECK(clocks.is_set_back(frame_of(1, kStartUs + 100'500)));
  CHECK_FALSE(clocks.is_set_back(frame_of(1, kStartUs + 100'750)));
}

TEST_CASE("a frame that waited for the next list is no clock that was set back") {
  BusClocks clocks;
  for (std::int64_t i = 0; i < 1000; ++i) {
    const std::int64_t late_us = i % 50 == 49 ? 75'000 : 0;
    CHECK_FALSE(clocks.is_set_back(frame_of(0, kStartUs + 250 * i - late_us)));
  }
}

TEST_CASE("the bus that is ahead of all others is told, not the others, and not one that is late") {
  const std::int64_t offset_us = GENERATE(1'000'000, -1'000'000);
  BusClocks clocks;
  for (std::int64_t i = 0; i < 1000; ++i) {
    const auto bus = static_cast<std::uint8_t>(i % 3);
    clocks.is_set_back(frame_of(bus, kStartUs + 250 * i + (bus == 2 ? offset_us : 0)));
  }
  CHECK_FALSE(clocks.is_ahead(0));
  CHECK_FALSE(clocks.is_ahead(1));
  CHECK(clocks.is_ahead(2) == (offset_us > 0));
  // Its clock is right again.
  for (std::int64_t i = 1000; i < 1100; ++i) {
    clocks.is_set_back(frame_of(static_cast<std::uint8_t>(i % 3), kStartUs + 250 * i));
  }
  CHECK_FALSE(clocks.is_ahead(2));
}

TEST_CASE("a bus that sends alone after the others stopped is not ahead") {
  BusClocks clocks;
  clocks.is_set_back(frame_of(0, kStartUs));
  for (std::int64_t i = 0; i < 1000; ++i) {
    clocks.is_set_back(frame_of(1, kStartUs + 10'000 * i));
  }
  CHECK_FALSE(clocks.is_ahead(1));
}

TEST_CASE("clocks agree until a frame is stamped before an earlier one of another bus") {
  BusClocks clocks;
  CHECK(clocks.agree(1, 1));
  CHECK_FALSE(clocks.agree(0, 1));
  clocks.note(frame_of(0, kStartUs));
  clocks.note(frame_of(1, kStartUs + 1'000));
  CHECK(clocks.follows(1, 0));
  CHECK_FALSE(clocks.agree(0, 1));             // No frame of 0 has come after one of 1.
  clocks.note(frame_of(0, kStartUs - 4'000));  // Five milliseconds are hardware stamps.
  CHECK(clocks.agree(0, 1));
  CHECK(clocks.agree(1, 0));
  clocks.note(frame_of(1, kStartUs - 9'001));
  CHECK_FALSE(clocks.agree(0, 1));
  CHECK(clocks.follows(0, 1));
  CHECK_FALSE(clocks.agree(0, 2));
}

/// Scans every 75 ms that count by two.
class Scans {
 public:
  bool next(ScanClock& clock, double later_s = 0.0, std::uint16_t lost = 0) {
    counter_ = static_cast<std::uint16_t>(counter_ + 2 * (1 + lost));
    stamp_us_ += 75'000 * (1 + lost) + static_cast<std::int64_t>(1e6 * later_s);
    RadarScan scan;
    scan.stamp_us = stamp_us_;
    scan.counter = counter_;
    return clock.is_set_forward(scan);
  }
  void skip_count() { counter_ = static_cast<std::uint16_t>(counter_ + 1000); }

 private:
  std::uint16_t counter_ = 65000;
  std::int64_t stamp_us_ = kStartUs;
};

TEST_CASE("a stamp that is later than its counter says shows a clock that was set forward") {
  const double step_s = GENERATE(0.1, 0.5, 30.0);
  ScanClock clock(65536);
  Scans scans;
  for (int i = 0; i < 400; ++i) {
    CHECK_FALSE(scans.next(clock, i % 2 == 0 ? 0.008 : -0.008));
  }
  CHECK(scans.next(clock, step_s));
  for (int i = 0; i < 20; ++i) {
    CHECK_FALSE(scans.next(clock));
  }
}

TEST_CASE("lost scans, a counter that begins anew, and short counters show no step") {
  ScanClock clock(65536);
  Scans scans;
  for (int i = 0; i < 50; ++i) {
    CHECK_FALSE(scans.next(clock, 0.0, i % 10 == 9 ? 20 : 0));
  }
  scans.skip_count();
  for (int i = 0; i < 20; ++i) {
    CHECK_FALSE(scans.next(clock));
  }
  ScanClock of_short_counter(16);
  for (int i = 0; i < 50; ++i) {
    CHECK_FALSE(scans.next(of_short_counter, i == 30 ? 0.5 : 0.0));
  }
}

TEST_CASE("two sensors with one id have no steady counter: nothing is known") {
  ScanClock clock(65536);
  int steps = 0;
  for (int i = 0; i < 200; ++i) {
    RadarScan scan;
    scan.stamp_us = kStartUs + 37'500 * i;
    scan.counter = static_cast<std::uint16_t>(i % 2 == 0 ? i : 30'000 + i);
    steps += clock.is_set_forward(scan) ? 1 : 0;
  }
  CHECK(steps == 0);
}

}  // namespace
}  // namespace cremed
