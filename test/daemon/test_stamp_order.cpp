// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>

#include <catch2/catch.hpp>

#include "daemon/source/stamp_order.hpp"

using namespace cremed;

namespace {

constexpr std::int64_t kSince1970Us = 1'700'000'000'000'000;

}  // namespace

TEST_CASE("Times of interfaces that interleave anyhow, and a clock that is set, are times") {
  StampOrder order;
  for (std::int64_t i = 0; i < 1000; ++i) {
    const std::int64_t set_us = i < 500 ? 0 : -3'600'000'000;
    order.add("can0", kSince1970Us + set_us + 1000 * i);
    order.add("can1", kSince1970Us + set_us + 1000 * i - 400'000);
  }
  CHECK(order.problem("x.log").empty());
  CHECK(StampOrder().problem("x.log").empty());
}

TEST_CASE("Times between frames, and lines out of order, are told apart") {
  StampOrder between;
  StampOrder shuffled;
  for (std::int64_t i = 0; i < 2000; ++i) {
    between.add("can0", i % 134 == 0 ? 30'000 : 249);  // Lists of 66 targets.
  }
  for (std::int64_t i = 0; i < 1000; ++i) {
    shuffled.add("can0", kSince1970Us + 1000 * (i * 7919 % 1000));
  }
  CHECK_THAT(between.problem("x.log"), Catch::StartsWith("x.log: ") &&
                                           Catch::Contains("`candump -td`") &&
                                           Catch::Contains("record with `candump -l`"));
  CHECK_THAT(shuffled.problem("x.log"), Catch::Contains("`sort -s -k1,1 LOG`"));
}

TEST_CASE("Logs of one interface each that were joined are not in the order of time") {
  StampOrder joined;
  StampOrder of_two_clocks;
  StampOrder of_two_drives;
  for (const char* interface : {"can0", "can1", "can2"}) {
    for (std::int64_t i = 0; i < 1000; ++i) {
      joined.add(interface, kSince1970Us + 1000 * i);
    }
  }
  for (std::int64_t i = 0; i < 1000; ++i) {
    of_two_clocks.add("can0", kSince1970Us + 1000 * i);
    of_two_clocks.add("can1", kSince1970Us + 1000 * i - 3'600'000'000);
    of_two_drives.add(i < 500 ? "can0" : "can1", kSince1970Us + 1000 * i);
  }
  CHECK_THAT(joined.problem("x.log"), Catch::StartsWith("x.log: one interface follows another") &&
                                          Catch::Contains("`sort -s -k1,1 LOG`"));
  CHECK(of_two_clocks.problem("x.log").empty());
  CHECK(of_two_drives.problem("x.log").empty());
}

TEST_CASE("Stamps that stand still are no times, but those of a few frames at once are") {
  StampOrder still;
  StampOrder burst;
  StampOrder coarse;
  for (std::int64_t i = 0; i < 1000; ++i) {
    still.add(i % 2 == 0 ? "can0" : "can1", kSince1970Us);
    coarse.add("can0", kSince1970Us + 10'000 * (i / 100));
  }
  for (std::int64_t i = 0; i < 10; ++i) {
    burst.add("can0", kSince1970Us);
  }
  CHECK_THAT(still.problem("x.log"),
             Catch::StartsWith("x.log: the stamps stand still: in 998 steps ") &&
                 Catch::EndsWith("record with `candump -l`"));
  CHECK(burst.problem("x.log").empty());
  CHECK(coarse.problem("x.log").empty());
}
