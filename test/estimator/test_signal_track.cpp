// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/signal_track.hpp"

namespace cremed {
namespace {

constexpr std::int64_t kBeginUs = 1'700'000'000'000'000;

std::vector<SignalTrack::Value> all_of(SignalTrack& track) {
  std::vector<SignalTrack::Value> values;
  for (auto value = track.front(); value; value = track.front()) {
    values.push_back(*value);
    track.pop();
  }
  return values;
}

TEST_CASE("readings become means over a period, at the mean time of their measurement") {
  SignalTrack track(0.05, 0.03);
  for (int i = 0; i < 11; ++i) {
    track.add(kBeginUs + 10'000 * i, 1.0 * i);
  }
  const auto values = all_of(track);
  REQUIRE(values.size() == 2);
  CHECK(values[0].utime_us == kBeginUs + 20'000 - 30'000);
  CHECK(values[0].value == Approx(2.0));
  CHECK(values[1].utime_us == kBeginUs + 70'000 - 30'000);
  CHECK(values[1].value == Approx(7.0));
}

TEST_CASE("a slow sender's readings are used one by one, also beside a gap") {
  SignalTrack track(0.05, 0.0);
  for (const std::int64_t at_us : {0, 100'000, 3'000'000, 3'100'000}) {
    track.add(kBeginUs + at_us, static_cast<double>(at_us));
  }
  const auto values = all_of(track);
  REQUIRE(values.size() == 3);
  CHECK(values[1].utime_us == kBeginUs + 100'000);
  CHECK(values[2].utime_us == kBeginUs + 3'000'000);
}

TEST_CASE("readings that nobody takes push out the earliest") {
  SignalTrack track(0.05, 0.0);
  for (int i = 0; i < 1000; ++i) {
    track.add(kBeginUs + 50'000 * i, 1.0 * i);
  }
  const auto values = all_of(track);
  CHECK(values.size() == 64);
  CHECK(values.back().value == 998.0);
  CHECK(values.front().value == 935.0);
}

TEST_CASE("when the clock is set back the readings before are dropped") {
  SignalTrack track(0.05, 0.0);
  for (int i = 0; i < 20; ++i) {
    track.add(kBeginUs + 10'000 * i, 1.0);
  }
  track.add(kBeginUs - 5'000'000, 2.0);
  CHECK(all_of(track).empty());
}

}  // namespace
}  // namespace cremed
