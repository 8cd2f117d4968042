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

/// Bursts of frames of three buses in turn, as of cluster lists; stamps of bus 2 are off.
void send_bursts(BusClocks& clocks, std::int64_t start_us, std::int64_t offset_us,
                 std::uint8_t buses = 3) {
  for (std::int64_t i = 0; i < 1000; ++i) {
    const auto bus = static_cast<std::uint8_t>(i / 20 % buses);
    clocks.note(frame_of(bus, start_us + 250 * i + (bus == buses - 1 ? offset_us : 0)));
  }
}

TEST_CASE("the bus that is ahead or behind of all others is told, not the others") {
  const std::int64_t offset_us =
      GENERATE(1'000'000, 250'000, 150'000, 50'000, -50'000, -150'000, -250'000, -1'000'000);
  BusClocks clocks;
  send_bursts(clocks, kStartUs, offset_us);
  for (std::uint8_t bus = 0; bus < 2; ++bus) {
    CHECK_FALSE(clocks.is_ahead(bus));
    CHECK_FALSE(clocks.is_behind(bus));
  }
  CHECK(clocks.is_ahead(2) == (offset_us > 100'000));
  CHECK(clocks.is_behind(2) == (offset_us < -100'000));
  // Its clock is right again.
  send_bursts(clocks, kStartUs + 250'000, 0);
  CHECK_FALSE(clocks.is_ahead(2));
  CHECK_FALSE(clocks.is_behind(2));
}

TEST_CASE("of two buses one is told only if no delay explains the difference") {
  const std::int64_t offset_us = GENERATE(250'000, 600'000);
  BusClocks clocks;
  send_bursts(clocks, kStartUs, offset_us, 2);
  CHECK(clocks.is_ahead(1) == (offset_us > 500'000));
  CHECK_FALSE(clocks.is_ahead(0));
  CHECK_FALSE(clocks.is_behind(0));
  CHECK_FALSE(clocks.is_behind(1));
}

TEST_CASE("a bus that sends alone after the others stopped is not ahead") {
  BusClocks clocks;
  clocks.note(frame_of(0, kStartUs));
  for (std::int64_t i = 0; i < 1000; ++i) {
    clocks.note(frame_of(1, kStartUs + 10'000 * i));
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
  ScanTiming next(ScanClock& clock, double later_s = 0.0, std::uint16_t lost = 0) {
    counter_ = static_cast<std::uint16_t>(counter_ + 2 * (1 + lost));
    stamp_us_ += 75'000 * (1 + lost) + static_cast<std::int64_t>(1e6 * later_s);
    RadarScan scan;
    scan.stamp_us = stamp_us_;
    scan.counter = counter_;
    return clock.judge(scan);
  }
  void skip_count() { counter_ = static_cast<std::uint16_t>(counter_ + 1000); }

 private:
  std::uint16_t counter_ = 65000;
  std::int64_t stamp_us_ = kStartUs;
};

void expect_steady(Scans& scans, ScanClock& clock, int count, double jitter_s = 0.0) {
  for (int i = 0; i < count; ++i) {
    CHECK(scans.next(clock, i % 2 == 0 ? jitter_s : -jitter_s) == ScanTiming::steady);
  }
}

TEST_CASE("stamps that are later than the counter says show a clock that was set forward") {
  const double step_s = GENERATE(0.1, 0.5, 30.0);
  ScanClock clock(65536);
  Scans scans;
  expect_steady(scans, clock, 400, 0.008);
  CHECK(scans.next(clock, step_s) == ScanTiming::late);
  CHECK(scans.next(clock) == ScanTiming::set_forward);
  REQUIRE(clock.step());
  CHECK(clock.step()->by_s == Approx(step_s).margin(0.01));
  CHECK(clock.step()->counted_s == Approx(0.15).margin(0.001));
  expect_steady(scans, clock, 20);
}

TEST_CASE("after a long pause a counter shows no step: logs may have been joined") {
  ScanClock clock(65536);
  Scans scans;
  expect_steady(scans, clock, 400);
  CHECK(scans.next(clock, 80'000.0, 200) == ScanTiming::late);
  CHECK(scans.next(clock) == ScanTiming::set_forward);
  CHECK_FALSE(clock.step());
}

TEST_CASE("scans that waited while the computer stood still are late, and the clock was not set") {
  const double halt_s = GENERATE(0.06, 0.1, 0.2);
  ScanClock clock(65536);
  Scans scans;
  expect_steady(scans, clock, 40, 0.008);
  for (int halt = 0; halt < 10; ++halt) {
    double late_s = halt_s;
    CHECK(scans.next(clock, late_s) == ScanTiming::late);
    for (; late_s > 0.075; late_s -= 0.0749) {
      CHECK(scans.next(clock, -0.0749) != ScanTiming::set_forward);
    }
    CHECK(scans.next(clock, -late_s) == ScanTiming::steady);
    expect_steady(scans, clock, 20);
  }
}

TEST_CASE("a sensor that is set to a longer period is not late for ever") {
  ScanClock clock(65536);
  Scans scans;
  expect_steady(scans, clock, 40);
  int late = 0;
  for (int i = 0; i < 20; ++i) {
    late += scans.next(clock, 0.075) == ScanTiming::late ? 1 : 0;
  }
  CHECK(late == 3);
  expect_steady(scans, clock, 20, 0.0);
}

TEST_CASE("lost scans and a counter that begins anew show no step") {
  ScanClock clock(65536);
  Scans scans;
  for (int i = 0; i < 50; ++i) {
    CHECK(scans.next(clock, 0.0, i % 10 == 9 ? 20 : 0) == ScanTiming::steady);
  }
  scans.skip_count();
  expect_steady(scans, clock, 20);
}

/// As a Bosch GPR's: four counts of 0.1 s.
constexpr int kShort = 4;
constexpr std::int64_t kGprPeriodUs = 100'000;

RadarScan gpr_scan(int number, std::int64_t later_us = 0) {
  RadarScan scan;
  // 4 ms to and fro.
  scan.stamp_us = kStartUs + kGprPeriodUs * number + (number % 2 == 0 ? 4'000 : 0) + later_us;
  scan.counter = static_cast<std::uint16_t>(number % kShort);
  return scan;
}

TEST_CASE("a short counter shows a clock that was set forward, but not by its whole turn") {
  const std::int64_t step_us = GENERATE(100'000, 250'000, 350'000, 500'000, 1'000'000);
  ScanClock clock(kShort);
  int number = 0;
  for (; number < 100; ++number) {
    CHECK(clock.judge(gpr_scan(number)) == ScanTiming::steady);
  }
  CHECK(clock.judge(gpr_scan(number, step_us)) == ScanTiming::late);
  CHECK(clock.judge(gpr_scan(number + 1, step_us)) == ScanTiming::set_forward);
  for (number += 2; number < 200; ++number) {
    CHECK(clock.judge(gpr_scan(number, step_us)) == ScanTiming::steady);
  }
  // Just as four scans that were lost.
  CHECK(clock.judge(gpr_scan(number, step_us + 400'000)) == ScanTiming::steady);
}

TEST_CASE("lost scans, halts and a restart of the sensor are no step by a short counter") {
  ScanClock clock(kShort);
  int number = 0;
  const auto steady = [&](int count, std::int64_t later_us = 0) {
    for (const int end = number + count; number < end; ++number) {
      CHECK(clock.judge(gpr_scan(number, later_us)) == ScanTiming::steady);
    }
  };
  steady(100);
  for (int lost = 1; lost < 12; ++lost) {
    number += lost;
    steady(20);
  }
  for (int halt = 0; halt < 10; ++halt) {
    // Slots that waited are a scan with a later stamp, or the rest of one.
    CHECK(clock.judge(gpr_scan(number++, 60'000)) == ScanTiming::late);
    steady(1);
    CHECK(clock.judge(gpr_scan(number - 1, 80'000)) == ScanTiming::late);
    steady(14);
    CHECK(clock.judge(gpr_scan(number++, 25'000)) == ScanTiming::steady);
    steady(5);
  }
  constexpr std::int64_t kRestartUs = 3'050'000;
  steady(40, kRestartUs);
}

TEST_CASE("two sensors with one id have no steady counter: nothing is known") {
  ScanClock clock(65536);
  int steps = 0;
  for (int i = 0; i < 200; ++i) {
    RadarScan scan;
    scan.stamp_us = kStartUs + 37'500 * i;
    scan.counter = static_cast<std::uint16_t>(i % 2 == 0 ? i : 30'000 + i);
    steps += clock.judge(scan) == ScanTiming::steady ? 0 : 1;
  }
  CHECK(steps == 0);
}

}  // namespace
}  // namespace cremed
