// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/scan/stamps.hpp"

using namespace cremed;

TEST_CASE("the next multiple of a period is after the stamp, rounded up, and none is skipped") {
  CHECK(next_multiple_us(0, 50) == 20'000);
  CHECK(next_multiple_us(19'999, 50) == 20'000);
  CHECK(next_multiple_us(20'000, 50) == 40'000);
  CHECK(next_multiple_us(1'700'000'000'999'999, 200) == 1'700'000'001'000'000);
  CHECK(next_multiple_us(-1, 50) == 0);
  CHECK(next_multiple_us(-20'001, 50) == -20'000);
  for (const std::int64_t rate_hz : {1, 3, 7, 30, 60, 143, 200}) {
    std::int64_t stamp_us = 1'699'999'999'000'000;
    for (std::int64_t i = 1; i <= 2 * rate_hz; ++i) {
      stamp_us = next_multiple_us(stamp_us, rate_hz);
      const std::int64_t since_us = stamp_us - 1'699'999'999'000'000;
      CHECK(since_us * rate_hz >= i * 1'000'000);
      CHECK((since_us - 1) * rate_hz < i * 1'000'000);
    }
  }
}
