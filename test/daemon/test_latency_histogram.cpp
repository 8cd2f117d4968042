// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/report/latency_histogram.hpp"

using namespace cremed;

TEST_CASE("Quantiles are never too small, and at most 1/16 too large") {
  for (const std::int64_t scale : {1, 37, 1'000, 123'457}) {
    LatencyHistogram histogram;
    std::vector<std::int64_t> durations;
    for (std::int64_t i = 1; i <= 1000; ++i) {
      durations.push_back(i * i % 997 * scale);
      histogram.add(durations.back());
    }
    std::ranges::sort(durations);
    for (const double share : {0.001, 0.5, 0.9, 0.99, 1.0}) {
      CAPTURE(scale, share);
      const auto rank = static_cast<std::size_t>(std::ceil(share * 1000.0)) - 1;
      const auto exact = static_cast<double>(durations[rank]);
      const auto found = static_cast<double>(histogram.quantile_us(share));
      CHECK(found >= exact);
      CHECK(found <= exact * (1.0 + 1.0 / 16.0));
    }
    CHECK(histogram.max_us() == durations.back());
    CHECK(histogram.count() == 1000);
  }
}

TEST_CASE("Whatever is added, nothing breaks") {
  LatencyHistogram histogram;
  CHECK(histogram.quantile_us(0.5) == 0);
  histogram.add(-5);
  CHECK(histogram.quantile_us(1.0) == 0);
  histogram.add(std::numeric_limits<std::int64_t>::max());
  CHECK(histogram.max_us() == std::numeric_limits<std::int64_t>::max());
  CHECK(histogram.quantile_us(0.0) == 0);
  CHECK(histogram.quantile_us(1.0) > 1'000'000'000);
  histogram.clear();
  CHECK(histogram.count() == 0);
  CHECK(histogram.max_us() == 0);
}
