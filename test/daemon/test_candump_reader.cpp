// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <set>
#include <string>

#include <catch2/catch.hpp>

#include "daemon/source/replay.hpp"
#include "test/daemon/temporary_file.hpp"

using namespace cremed;

namespace {

volatile std::sig_atomic_t not_stopped = 0;

}  // namespace

TEST_CASE("A log hands out frames of known interfaces and counts the rest") {
  const TemporaryFile file(
      "# a comment\n"
      "(1.000000) can1 600#0000000010\n"
      "(1.000100) vcan9 123#00\n"
      "(1.000200) can0 nonsense\n"
      "DROPCOUNT: dropped 12 CAN frames on 'can0' socket (total drops 12)\n"
      "DROPCOUNT: dropped 3 CAN frames on 'vcan9' socket (total drops 3)\n"
      "(1.000300) can0 701#0011223344556677\n");
  Replay log({file.path()}, {"can0", "can1"}, 0.0, &not_stopped);
  CanFrame frame;

  REQUIRE(log.next(frame) == SourceEvent::frame);
  CHECK(frame.id == 0x600);
  CHECK(frame.interface == 1);
  CHECK(frame.stamp_us == 1'000'000);
  REQUIRE(log.next(frame) == SourceEvent::dropped);
  CHECK(frame.interface == 0);
  REQUIRE(log.next(frame) == SourceEvent::frame);
  CHECK(frame.id == 0x701);
  CHECK(frame.interface == 0);
  CHECK(log.next(frame) == SourceEvent::end);

  CHECK(log.counters().frames == 2);
  CHECK(log.counters().other_interface_frames == 1);
  CHECK(log.counters().lost_frames == 15);
  CHECK(log.counters().malformed_lines == 1);
  CHECK(log.has_frames(1));
  CHECK(log.other_interfaces() == std::set<std::string>{"vcan9"});
  CHECK(log.logs()[0].cut_off().empty());
  CHECK_THAT(log.logs()[0].malformed(),
             Catch::StartsWith(file.path() + ":4: ") && Catch::EndsWith(" (1 such line)"));
}

TEST_CASE("What candump lost of all interfaces may be of each") {
  const TemporaryFile file(
      "(1.000000) can1 600#0000000010\n"
      "DROPCOUNT: dropped 12 CAN frames on 'any' socket (total drops 12)\n"
      "(1.000300) can0 701#0011223344556677\n"
      "(1.000400) can1 702#0011223344556677\n");
  Replay log({file.path()}, {"can0", "can1"}, 0.0, &not_stopped);
  CanFrame frame;
  REQUIRE(log.next(frame) == SourceEvent::frame);
  for (std::uint8_t interface = 0; interface < 2; ++interface) {
    REQUIRE(log.next(frame) == SourceEvent::dropped);
    CHECK(frame.interface == interface);
    REQUIRE(log.next(frame) == SourceEvent::frame);
    CHECK(frame.id == 0x701U + interface);
  }
  CHECK(log.next(frame) == SourceEvent::end);
  CHECK(log.counters().lost_frames == 12);
}

TEST_CASE("A log that ends inside a line was cut off, which is no malformed line") {
  struct Row {
    const char* end;
    bool is_cut_off;
  };
  const auto row = GENERATE(Row{"(1.000100) can0 60", true}, Row{"(1.0001", true},
                            Row{"(1.000100) can0 701#00112233445566", true},  // Of 8 bytes.
                            Row{"(1.000100) can0 701#0011223344556677", false},
                            Row{"(1.000100) can0 600#0000000010\n", false}, Row{"# end", false});
  CAPTURE(row.end);
  const TemporaryFile file(std::string("(1.000000) can0 600#0000000010\n") + row.end);
  Replay log({file.path()}, {"can0"}, 0.0, &not_stopped);
  CanFrame frame;
  std::size_t frames = 0;
  while (log.next(frame) == SourceEvent::frame) {
    ++frames;
  }
  CHECK(frames == (std::string_view(row.end).find('#') > 1 && !row.is_cut_off ? 2 : 1));
  CHECK(log.logs()[0].malformed().empty());
  CHECK(
      log.logs()[0].cut_off() ==
      (row.is_cut_off ? file.path() + ":2: the log ends within this line, which is left out" : ""));
}

TEST_CASE("The zeros that a power failure leaves at the end of a log are no malformed line") {
  const auto size = GENERATE(as<std::size_t>{}, 4096, 131072);
  const TemporaryFile file("(1.000000) can0 600#0000000010\n" + std::string(size, '\0'));
  Replay log({file.path()}, {"can0"}, 0.0, &not_stopped);
  CanFrame frame;
  CHECK(log.next(frame) == SourceEvent::frame);
  CHECK(log.next(frame) == SourceEvent::end);
  CHECK(log.logs()[0].malformed().empty());
  CHECK_FALSE(log.logs()[0].cut_off().empty());
}

TEST_CASE("A last line that is malformed but whole is a fault") {
  const TemporaryFile file("(1.000000) can0 600#0000000010\n(1.000100) can0 60\n");
  Replay log({file.path()}, {"can0"}, 0.0, &not_stopped);
  CanFrame frame;
  CHECK(log.next(frame) == SourceEvent::frame);
  CHECK(log.next(frame) == SourceEvent::end);
  CHECK(log.logs()[0].malformed_lines() == 1);
  CHECK(log.logs()[0].cut_off().empty());
}

TEST_CASE("Of a log without a frame the first malformed line tells why") {
  const TemporaryFile file("  can0  600   [2]  00 11\n  can0  600   [2]  00 11\n");
  Replay log({file.path()}, {"can0"}, 0.0, &not_stopped);
  CanFrame frame;
  CHECK(log.next(frame) == SourceEvent::end);
  CHECK_THAT(log.logs()[0].no_frame(), Catch::Contains("no CAN frame in it; ") &&
                                           Catch::Contains(":1: console output without time") &&
                                           Catch::EndsWith(" (2 such lines)"));
}

TEST_CASE("A request to stop ends the log") {
  const TemporaryFile file("(1.000000) can0 600#0000000010\n(1.000000) can0 600#0000000010\n");
  volatile std::sig_atomic_t stop = 0;
  Replay log({file.path()}, {"can0"}, 0.0, &stop);
  CanFrame frame;
  REQUIRE(log.next(frame) == SourceEvent::frame);
  stop = 1;
  CHECK(log.next(frame) == SourceEvent::end);
}
