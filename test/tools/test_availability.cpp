// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include <catch2/catch.hpp>

#include "tools/eval/drive/missing_time.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"

using namespace cremed;

namespace {

/// A usable row each 0.1 s.
std::vector<RowTime> rows(std::int64_t count) {
  std::vector<RowTime> result;
  for (std::int64_t i = 0; i < count; ++i) {
    result.push_back({100'000 * i, true});
  }
  return result;
}

}  // namespace

TEST_CASE("Rows that come as usual leave nothing untold") {
  const Availability whole = availability(rows(11), {0, 1'000'000});
  CHECK(whole.percent == 100.0);
  CHECK(whole.without.empty());
}

TEST_CASE("What is not usable, a pause, and what is missing at the ends tell nothing") {
  std::vector<RowTime> some = rows(41);
  some[5].is_usable = some[6].is_usable = false;
  some.erase(some.begin() + 21, some.begin() + 24);  // 0.4 s
  some.erase(some.begin() + 30, some.begin() + 31);  // 0.2 s: a lost scan.
  const Availability found = availability(some, {-300'000, 4'700'000});
  REQUIRE(found.without.size() == 4);
  CHECK(found.without[0].end_us == 0);
  CHECK(found.without[1].begin_us == 400'000);
  CHECK(found.without[1].end_us == 600'000);
  CHECK(found.without[2].begin_us == 2'000'000);
  CHECK(found.without[2].end_us == 2'400'000);
  CHECK(found.without[3].begin_us == 4'000'000);
  CHECK(found.percent == Approx(100.0 - 100.0 * (0.3 + 0.2 + 0.4 + 0.7) / 5.0));
}

TEST_CASE("Rows that come once a second make no pauses") {
  const std::vector<RowTime> slow{
      {0, true}, {1'000'000, true}, {2'000'000, true}, {3'000'000, true}};
  CHECK(availability(slow, {0, 3'000'000}).percent == 100.0);
}

TEST_CASE("Without a row nothing is available") {
  CHECK(availability({}, {0, 1'000'000}).percent == 0.0);
  CHECK(availability({}, {0, 1'000'000}).without.size() == 1);
}

TEST_CASE("What lacks from the begin on is told without a sign") {
  CHECK(told_spans({{980'000, 1'600'000}}, 1'000'000) == ", nothing from 0.0 s to 0.6 s");
}
