// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <catch2/catch.hpp>

#include "tools/eval/drive/truth_noise.hpp"

using namespace cremed;

TEST_CASE("Without noise of truth nothing is added and nothing is noted") {
  const TruthNoise none;
  CHECK(none.covariance(100'000).isZero(0.0));
  CHECK(none.note().empty());
}

TEST_CASE("One standard deviation holds for every interval") {
  const TruthNoise noise({{0.01, 0.02, 0.001, 0.0}});
  for (const std::int64_t interval_us : {-1'000'000, 0, 75'000, 30'000'000}) {
    CAPTURE(interval_us);
    const Eigen::Matrix3d covariance = noise.covariance(interval_us);
    CHECK(covariance(0, 0) == Approx(1e-4));
    CHECK(covariance(1, 1) == Approx(4e-4));
    CHECK(covariance(2, 2) == Approx(1e-6));
    CHECK(covariance.isDiagonal());
  }
  CHECK(noise.note() == "truth's own std added to the covariance: 0.01, 0.02 m, 0.001 rad");
}

TEST_CASE("Several are interpolated by the interval, in whatever order they come") {
  const TruthNoise noise({{0.05, 0.02, 0.002, 1.0}, {0.01, 0.004, 0.001, 0.1}});
  CHECK(noise.covariance(10'000)(0, 0) == Approx(1e-4));
  CHECK(noise.covariance(100'000)(0, 0) == Approx(1e-4));
  CHECK(noise.covariance(550'000)(0, 0) == Approx(0.03 * 0.03));
  CHECK(noise.covariance(550'000)(1, 1) == Approx(0.012 * 0.012));
  CHECK(noise.covariance(550'000)(2, 2) == Approx(0.0015 * 0.0015));
  CHECK(noise.covariance(1'000'000)(0, 0) == Approx(0.05 * 0.05));
  CHECK(noise.covariance(9'000'000)(0, 0) == Approx(0.05 * 0.05));
  CHECK(noise.note().find("0.01, 0.004 m, 0.001 rad over 0.1 s; 0.05") != std::string::npos);
}
