// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include <catch2/catch.hpp>

#include "tools/eval/drive/drive_evaluation.hpp"

using namespace cremed;

namespace {

EstimateError nees_at(std::int64_t utime_us, double nees) {
  EstimateError error;
  error.utime_us = utime_us;
  error.nees = nees;
  return error;
}

}  // namespace

TEST_CASE("NEES is averaged over the estimates at most half a window away") {
  const std::vector<EstimateError> estimates{nees_at(0, 1.0), nees_at(500'000, 2.0),
                                             nees_at(1'000'000, 6.0), nees_at(1'000'001, 20.0),
                                             nees_at(9'000'000, 0.5)};
  const auto running = running_nees(estimates, 2);
  REQUIRE(running.size() == 5);
  CHECK(running[0].mean == Approx(3.0));
  CHECK(running[1].mean == Approx(29.0 / 4.0));
  CHECK(running[2].mean == Approx(29.0 / 4.0));
  CHECK(running[3].mean == Approx(28.0 / 3.0));
  CHECK(running[4].mean == Approx(0.5));
  CHECK(running_nees({}, 2).empty());
}

TEST_CASE("Its interval is that of the mean of as many") {
  const std::vector<EstimateError> estimates{nees_at(0, 1.0), nees_at(100'000, 1.0),
                                             nees_at(5'000'000, 1.0)};
  const auto running = running_nees(estimates, 3);
  for (const auto& [index, count] : {std::pair<std::size_t, std::size_t>{0, 2}, {1, 2}, {2, 1}}) {
    CAPTURE(index);
    const Interval wanted = anees_interval(count, 3, 0.95);
    CHECK(running[index].interval.low == wanted.low);
    CHECK(running[index].interval.high == wanted.high);
  }
}
