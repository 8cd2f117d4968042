// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// UDP replaces CAN, as in test_can_socket; interfaces are tested in test/vm.
#include <chrono>
#include <csignal>
#include <thread>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/source/live_source.hpp"
#include "test/daemon/datagram_pair.hpp"
#include "test/daemon/hardware_stamps.hpp"
#include "test/daemon/moved_clock.hpp"

using namespace cremed;
using cremed::test::DatagramPair;
using cremed::test::stop_for;

namespace {

constexpr std::int64_t kMaxLatencyUs = 500'000;

Configuration absent_radars(std::size_t radars) {
  Configuration configuration;
  for (std::size_t i = 0; i < radars; ++i) {
    RadarConfiguration radar;
    radar.name = radar.interface = "absent" + std::to_string(i);
    configuration.radars.push_back(radar);
  }
  configuration.live.max_latency_s = 1e-6 * kMaxLatencyUs;
  configuration.live.socket.hardware_stamps = test::hardware_ahead_us.has_value();
  return configuration;
}

/// A source whose interfaces are sockets of the test.
class SourceBench {
 public:
  explicit SourceBench(std::size_t interfaces)
      : pairs(interfaces), source(absent_radars(interfaces), &stop) {
    test::realtime_ahead_us = 0;
    for (std::size_t i = 0; i < interfaces; ++i) {
      source.interfaces()[i]->adopt(pairs[i].receiver());
    }
  }

  SourceEvent next() { return source.next(frame); }
  /// The next event but idle ones.
  SourceEvent next_but_idle() {
    SourceEvent event = next();
    while (event == SourceEvent::idle) {
      event = next();
    }
    return event;
  }
  std::uint64_t stale(std::uint8_t interface = 0) { return source.bus(interface).frames_stale; }

  volatile std::sig_atomic_t stop = 0;
  std::vector<DatagramPair> pairs;
  LiveSource source;
  CanFrame frame;
};

/// The kernel begins to stamp what arrives a moment after a socket has asked for that; until then
/// reading stamps it.
void wait_for_stamps(SourceBench& bench) {
  std::int64_t sent_us = 0;
  do {
    bench.pairs[0].send(1, 8);
    sent_us = realtime_us();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    REQUIRE(bench.next_but_idle() == SourceEvent::frame);
  } while (bench.frame.stamp_us > sent_us);
}

}  // namespace

TEST_CASE("A frame that is read in time and handed out too late is stale") {
  SourceBench bench(1);
  for (canid_t id = 1; id <= 10; ++id) {
    bench.pairs[0].send(id, 8);
  }
  REQUIRE(bench.next() == SourceEvent::frame);  // All are read now.
  CHECK(bench.frame.id == 1);
  stop_for(2 * kMaxLatencyUs);
  CHECK(bench.next() == SourceEvent::dropped);
  CHECK(bench.frame.interface == 0);
  for (int i = 0; i < 8; ++i) {
    CHECK(bench.next() == SourceEvent::idle);
  }
  CHECK(bench.stale() == 9);
  CHECK(bench.source.counters().frames == 1);
}

TEST_CASE("Stale frames tell the time of which nothing is left to read, so that scans time out") {
  SourceBench bench(1);
  const std::int64_t before_us = realtime_us();
  bench.pairs[0].send(1, 8);
  bench.pairs[0].send(2, 8);
  const std::int64_t after_us = realtime_us();
  stop_for(2 * kMaxLatencyUs);
  REQUIRE(bench.next() == SourceEvent::dropped);
  REQUIRE(bench.next() == SourceEvent::idle);
  CHECK(bench.frame.stamp_us <= after_us);
  CHECK(bench.frame.stamp_us >= before_us - 50'000);
}

TEST_CASE("Once late it makes up half of the delay, and then hands frames out again") {
  SourceBench bench(1);
  const auto next_at_age = [&](std::int64_t percent) {
    test::realtime_ahead_us = kMaxLatencyUs * percent / 100;
    bench.pairs[0].send(1, 8);
    return bench.next();
  };
  CHECK(next_at_age(60) == SourceEvent::frame);
  CHECK(next_at_age(120) == SourceEvent::dropped);
  CHECK(next_at_age(60) == SourceEvent::idle);
  CHECK(next_at_age(40) == SourceEvent::frame);
  CHECK(next_at_age(60) == SourceEvent::frame);
  CHECK(bench.stale() == 2);
}

TEST_CASE(
    "A frame is late by the time since the kernel received it, whatever the controller stamps") {
  test::hardware_ahead_us = 15'000;
  SourceBench bench(1);
  test::realtime_ahead_us = kMaxLatencyUs + 1000;
  bench.pairs[0].send(1, 8);
  CHECK(bench.next() == SourceEvent::dropped);
  CHECK(bench.stale() == 1);
  test::hardware_ahead_us.reset();
}

TEST_CASE("Error frames are counted and tell the time; those that lost frames are drops") {
  SourceBench bench(1);
  bench.pairs[0].send(CAN_ERR_FLAG | 0x80, 8);  // CAN_ERR_BUSERROR.
  CHECK(bench.next() == SourceEvent::idle);
  CHECK(bench.source.bus(0).error_frames == 1);
  CHECK(bench.source.counters().frames == 0);
}

TEST_CASE("Frames of several interfaces come by stamp, and none is waited for on a silent one") {
  SourceBench bench(3);
  wait_for_stamps(bench);
  const std::vector<std::pair<std::size_t, canid_t>> sent = {
      {0, 1}, {1, 2}, {0, 3}, {1, 4}, {1, 5}};
  for (const auto& [interface, id] : sent) {
    bench.pairs[interface].send(id, 8);
    std::this_thread::sleep_for(std::chrono::microseconds(2));  // Stamps are in microseconds.
  }
  for (const auto& [interface, id] : sent) {
    REQUIRE(bench.next_but_idle() == SourceEvent::frame);
    CHECK(bench.frame.id == id);
    CHECK(bench.frame.interface == interface);
  }
  CHECK(bench.stale(2) == 0);
}

TEST_CASE("Silence is an event, and a stop ends it") {
  SourceBench bench(1);
  CHECK(bench.next() == SourceEvent::idle);
  bench.stop = 1;
  CHECK(bench.next() == SourceEvent::end);
}

TEST_CASE("An interface that is absent is told so, and nothing can be sent on it") {
  volatile std::sig_atomic_t stop = 0;
  LiveSource source(absent_radars(1), &stop);
  CHECK((source.bus(0).link == LinkState::absent || source.bus(0).link == LinkState::failed));
  CHECK(source.interfaces()[0]->send(CanFrame{}) == ENODEV);
  CHECK(source.bus(0).send_failures == 1);
}
