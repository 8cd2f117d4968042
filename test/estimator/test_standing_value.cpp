// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/standing_value.hpp"

namespace cremed {
namespace {

constexpr double kTolerance = 0.1;

TEST_CASE("a value that stays for 0.2 s stands; it is frozen if the true one changes") {
  StandingValue value(0.5);
  double truth = 8.0;
  for (std::int64_t at_us = 0; at_us <= 4'000'000; at_us += 20'000) {
    value.add(at_us, 8.0);
    value.expect(truth, kTolerance);
    CAPTURE(at_us);
    CHECK(value.is_standing() == (at_us >= 200'000));
    // Brakes by 0.5 m/s each second: beyond doubt after 1.4 s.
    CHECK(value.is_frozen() == (at_us >= 2'000'000));
    truth -= 0.01;
  }
  value.add(4'020'000, 6.0);
  CHECK_FALSE(value.is_standing());
  CHECK_FALSE(value.is_frozen());
}

TEST_CASE("a vehicle that stands or cruises is not frozen, nor is one of uncertain speed") {
  const double tolerance = GENERATE(0.1, 3.0);
  StandingValue value(0.5);
  for (int i = 0; i < 1000; ++i) {
    value.add(20'000 * i, 0.0);
    value.expect((tolerance > 1.0 ? 4.0 : 0.3) * (i % 2), tolerance);
  }
  CHECK(value.is_standing());
  CHECK_FALSE(value.is_frozen());
}

TEST_CASE("a value that flickers between two steps does not stand") {
  StandingValue value(0.5);
  for (int i = 0; i < 1000; ++i) {
    value.add(20'000 * i, 0.02 * (i / 5 % 2));
    CHECK_FALSE(value.is_standing());
  }
}

}  // namespace
}  // namespace cremed
