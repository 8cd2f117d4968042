// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// UDP replaces CAN, as in test_can_socket.
#include <catch2/catch.hpp>

#include "daemon/source/bus_connection.hpp"
#include "test/daemon/datagram_pair.hpp"

using namespace cremed;
using cremed::test::DatagramPair;

namespace {

/// The adopted socket has no interface: index 0.
constexpr Link kUp{0, true, 0};
constexpr Link kDown{0, false, 0};
constexpr Link kRecreated{1'000'000, true, 0};

struct ConnectionBench {
  ConnectionBench() { bus.adopt(pair.receiver()); }
  DatagramPair pair;
  BusConnection bus{"absent", IdSet().set(1), {}};
};

}  // namespace

TEST_CASE("A bus that goes down keeps its socket, and each time counts once") {
  ConnectionBench bench;
  CHECK(bench.bus.status().link == LinkState::up);
  for (const std::uint64_t times : {1U, 2U}) {
    bench.bus.maintain(kDown);
    bench.bus.maintain(kDown);
    CHECK(bench.bus.status().link == LinkState::down);
    bench.bus.maintain(kUp);
    CHECK(bench.bus.status().link == LinkState::up);
    CHECK(bench.bus.status().interruptions == times);
  }
  bench.pair.send(1, 8);
  CHECK(bench.bus.receive().frames.size() == 1);
}

TEST_CASE("A bus that was down begins as error active") {
  ConnectionBench bench;
  bench.bus.status().bus = BusState::bus_off;
  bench.bus.maintain(kUp);
  CHECK(bench.bus.status().bus == BusState::bus_off);
  bench.bus.maintain(kDown);
  bench.bus.maintain(kUp);
  CHECK(bench.bus.status().bus == BusState::error_active);
}

TEST_CASE("A recreated interface needs another socket") {
  ConnectionBench bench;
  bench.bus.maintain(kRecreated);
  CHECK(bench.bus.descriptor() < 0);  // It cannot be opened either.
  CHECK(bench.bus.status().link != LinkState::up);
  CHECK(bench.bus.status().interruptions == 1);
  const CanReceiveResult result = bench.bus.receive();
  CHECK(result.error == 0);
  CHECK(result.frames.empty());
  CHECK(bench.bus.send({}) == ENODEV);
  CHECK(bench.bus.status().send_failures == 1);
}

TEST_CASE("A failed question about the interface changes an open bus in nothing") {
  ConnectionBench bench;
  bench.bus.maintain({0, false, ENOBUFS});
  CHECK(bench.bus.status().link == LinkState::up);
  BusConnection closed("absent", IdSet().set(1), {});
  closed.maintain({0, false, ENOBUFS});
  CHECK(closed.status().link == LinkState::failed);
  CHECK(closed.status().error == ENOBUFS);
}
