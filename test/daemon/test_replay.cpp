// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <csignal>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/process/clocks.hpp"
#include "daemon/source/replay.hpp"
#include "test/daemon/temporary_file.hpp"

using namespace cremed;

namespace {

volatile std::sig_atomic_t no_stop = 0;

Replay replay_of(const std::vector<const TemporaryFile*>& files, double speed = 0.0) {
  std::vector<std::string> paths;
  for (const TemporaryFile* file : files) {
    paths.push_back(file->path());
  }
  return {paths, {"can0", "can1"}, speed, &no_stop};
}

std::vector<std::uint32_t> ids(Replay& replay) {
  std::vector<std::uint32_t> result;
  CanFrame frame;
  for (auto event = replay.next(frame); event != SourceEvent::end; event = replay.next(frame)) {
    result.push_back(event == SourceEvent::dropped ? 0U : frame.id);
  }
  return result;
}

}  // namespace

TEST_CASE("Several logs are merged by time, the first interface first where stamps are equal") {
  const TemporaryFile a("(1.000000) can0 001#\n(3.000000) can0 003#\n(4.000000) can0 004#\n");
  const TemporaryFile b("(2.000000) can1 002#\n(3.000000) can1 103#\n(9.000000) can1 009#\n");
  Replay forward = replay_of({&a, &b});
  CHECK(ids(forward) == std::vector<std::uint32_t>{1, 2, 3, 0x103, 4, 9});
  CHECK(forward.traffic_s() == Approx(8.0));
  CHECK(forward.counters().frames == 6);
  Replay swapped = replay_of({&b, &a});
  CHECK(ids(swapped) == std::vector<std::uint32_t>{1, 2, 3, 0x103, 4, 9});
}

TEST_CASE("The share read is that of the bytes of all logs, and unknown of a pipe") {
  const std::string line = "(1.000000) can0 001#\n";
  std::string lines = line;
  while (lines.size() < 2 * 65536) {
    lines += "(1.100000) can1 002#\n";
  }
  const TemporaryFile a(lines);
  const TemporaryFile b(line + line);
  Replay replay = replay_of({&a, &b});
  CHECK(replay.share_read() == 0.0);
  CanFrame frame;
  REQUIRE(replay.next(frame) == SourceEvent::frame);  // Of each log one buffer is read.
  const auto all = static_cast<double>(lines.size() + 2 * line.size());
  CHECK(*replay.share_read() == Approx((65536.0 + 2.0 * static_cast<double>(line.size())) / all));
  CHECK_FALSE(Replay({"/dev/null"}, {"can0"}, 0.0, &no_stop).share_read());
}

TEST_CASE("A report of lost frames comes before the frame behind it") {
  const TemporaryFile a(
      "(1.000000) can0 001#\nDROPCOUNT: dropped 4 CAN frames on 'can0' socket (total drops 4)\n"
      "(5.000000) can0 005#\n");
  const TemporaryFile b("(2.000000) can1 002#\n");
  Replay replay = replay_of({&a, &b});
  CHECK(ids(replay) == std::vector<std::uint32_t>{1, 2, 0, 5});
}

TEST_CASE("A log whose clock runs back keeps its own order") {
  const TemporaryFile file("(5.000000) can0 005#\n(1.000000) can0 001#\n(6.000000) can0 006#\n");
  Replay replay = replay_of({&file});
  CHECK(ids(replay) == std::vector<std::uint32_t>{5, 1, 6});
}

TEST_CASE("Interfaces of one log that were logged out of order are put into it") {
  const TemporaryFile file(
      "(1.000000) can1 101#\n(1.100000) can1 102#\n(0.900000) can0 001#\n(1.000000) can0 002#\n"
      "DROPCOUNT: dropped 4 CAN frames on 'can0' socket (total drops 4)\n"
      "(1.200000) can0 003#\n(1.150000) can1 103#\n");
  Replay replay = replay_of({&file});
  CHECK(ids(replay) == std::vector<std::uint32_t>{1, 2, 0x101, 0x102, 0x103, 0, 3});
}

TEST_CASE("Interfaces whose clocks are far apart keep the order of their lines") {
  const TemporaryFile file(
      "(5.000000) can0 001#\n(9.000000) can1 101#\n(5.100000) can0 002#\n"
      "(9.100000) can1 102#\n(9.200000) can1 103#\n(5.200000) can0 003#\n");
  Replay replay = replay_of({&file});
  CHECK(ids(replay) == std::vector<std::uint32_t>{1, 0x101, 2, 0x102, 0x103, 3});
}

TEST_CASE("An interface that is silent for long holds nothing back without end") {
  std::string text = "(1.000000) can0 001#\n";
  for (int i = 0; i < 10'000; ++i) {
    text += "(1.000000) can1 101#\n";
  }
  const TemporaryFile file(text + "(1.100000) can0 002#\n");
  Replay replay = replay_of({&file});
  const std::vector<std::uint32_t> all = ids(replay);
  REQUIRE(all.size() == 10'002);
  CHECK(all.front() == 1);
  CHECK(all.back() == 2);
}

TEST_CASE("At a finite speed a frame is not early") {
  const TemporaryFile file("(1.000000) can0 001#\n(1.200000) can0 002#\n");
  Replay replay = replay_of({&file}, 4.0);
  CanFrame frame;
  REQUIRE(replay.next(frame) == SourceEvent::frame);
  const std::int64_t begin_us = monotonic_us();
  REQUIRE(replay.next(frame) == SourceEvent::frame);
  CHECK(monotonic_us() - begin_us >= 45'000);  // 0.2 s at fourfold speed, less what next() took
}

TEST_CASE("A jump of the log's clock is not waited for, nor counted as traffic") {
  const TemporaryFile file(
      "(1.000000) can0 001#\n(1.010000) can0 002#\n(999999999999.000000) can0 003#\n"
      "(999999999999.010000) can0 004#\n(5.000000) can0 005#\n(5.010000) can0 006#\n");
  Replay replay = replay_of({&file}, 1.0);
  const std::int64_t begin_us = monotonic_us();
  CHECK(ids(replay).size() == 6);
  const std::int64_t took_us = monotonic_us() - begin_us;
  CHECK(took_us >= 25'000);  // three steps of 10 ms are paced
  CHECK(took_us < 5'000'000);
  CHECK(replay.traffic_s() == Approx(0.03).margin(1e-3));
}
