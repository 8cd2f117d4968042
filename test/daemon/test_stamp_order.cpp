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
  for (std::int64_t i = 0; i < 1000; ++i) {
    between.add("can0", i % 20 == 0 ? 30'000 : 249);
    shuffled.add("can0", kSince1970Us + 1000 * (i * 7919 % 1000));
  }
  CHECK_THAT(between.problem("x.log"), Catch::StartsWith("x.log: ") &&
                                           Catch::Contains("`candump -td`") &&
                                           Catch::Contains("record with `candump -l`"));
  CHECK_THAT(shuffled.problem("x.log"), Catch::Contains("`sort -s -k1,1 LOG`"));
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
