// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <limits>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/nis_mean.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kStartUs = 1'700'000'000'000'000;
constexpr std::int64_t kSecondUs = 1'000'000;

/// Adds a number of NIS per second from `begin_s` on.
void feed(NisMean& mean, double nis, std::int64_t begin_s, std::int64_t end_s, int rate_hz = 10) {
  for (std::int64_t us = begin_s * kSecondUs; us < end_s * kSecondUs; us += kSecondUs / rate_hz) {
    mean.add(kStartUs + us, nis);
  }
}

TEST_CASE("NIS mean: without any there is no judgement") {
  NisMean mean;
  CHECK(mean.count() == 0);
  CHECK(mean.mean() == 0.0);
  CHECK_FALSE(mean.is_enough());
  feed(mean, 20.0, 0, 9);
  CHECK(mean.count() == 90);
  CHECK_FALSE(mean.exceeds(1.0));
  feed(mean, 20.0, 9, 10);
  CHECK(mean.is_enough());
  CHECK(mean.exceeds(1.0));
  CHECK_FALSE(mean.exceeds(20.0));
  mean.clear();
  CHECK(mean.count() == 0);
}

TEST_CASE("NIS mean: the window is a minute at any rate") {
  const int rate_hz = GENERATE(1, 10, 50);
  NisMean mean;
  feed(mean, 4.0, 0, 100, rate_hz);
  CHECK(mean.count() == 60U * static_cast<unsigned>(rate_hz));
  CHECK(mean.mean() == Approx(4.0));
  feed(mean, 1.0, 100, 130, rate_hz);
  CHECK(mean.mean() == Approx(2.5));
  feed(mean, 1.0, 130, 160, rate_hz);
  CHECK(mean.mean() == Approx(1.0));
  CHECK(mean.count() == 60U * static_cast<unsigned>(rate_hz));
}

TEST_CASE("NIS mean: a few outliers have little effect") {
  NisMean mean;
  feed(mean, 1.0, 0, 59);
  mean.add(kStartUs + 59 * kSecondUs, 1e12);
  mean.add(kStartUs + 59 * kSecondUs, std::numeric_limits<double>::infinity());
  CHECK(mean.mean() == Approx((590.0 + 2 * 25.0) / 592.0));
}

TEST_CASE("NIS mean: the window includes pauses") {
  NisMean mean;
  feed(mean, 9.0, 0, 30);
  feed(mean, 1.0, 75, 80);
  CHECK(mean.count() == 100 + 50);  // The last 10 of the first 30 s.
  mean.pass(kStartUs + 120 * kSecondUs);
  CHECK(mean.count() == 50);
  CHECK(mean.mean() == Approx(1.0));
  mean.pass(kStartUs + 500 * kSecondUs);
  CHECK(mean.count() == 0);
  CHECK(mean.mean() == 0.0);
}

TEST_CASE("NIS mean: a step back in time clears it, at any time") {
  NisMean mean;
  feed(mean, 9.0, 100, 130);
  mean.add(kStartUs + 50 * kSecondUs, 2.0);
  CHECK(mean.count() == 1);
  CHECK(mean.mean() == 2.0);
  for (const std::int64_t utime_us :
       {std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min(),
        std::int64_t{-500 * kSecondUs}, std::int64_t{0}}) {
    mean.add(utime_us, 3.0);
    CHECK(mean.count() == 1);
    CHECK(mean.mean() == 3.0);
  }
}

}  // namespace
}  // namespace cremed
