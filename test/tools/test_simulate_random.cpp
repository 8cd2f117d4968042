// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstddef>

#include <catch2/catch.hpp>

#include "tools/simulate/random.hpp"

using cremed::Random;

namespace {

constexpr int kCount = 400'000;

}  // namespace

TEST_CASE("normal numbers have the moments of the normal distribution") {
  Random random(7, 3);
  std::array<double, 4> moments{};
  double product = 0.0;
  double previous = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    for (std::size_t k = 0; k < 4; ++k) moments[k] += std::pow(value, k + 1) / kCount;
    product += value * previous / kCount;
    previous = value;
  }
  // Five standard deviations of each estimate.
  const double unit = 5.0 / std::sqrt(static_cast<double>(kCount));
  CHECK(std::abs(moments[0]) < unit);
  CHECK(std::abs(moments[1] - 1.0) < unit * std::sqrt(2.0));
  CHECK(std::abs(moments[2]) < unit * std::sqrt(15.0));
  CHECK(std::abs(moments[3] - 3.0) < unit * std::sqrt(96.0));
  CHECK(std::abs(product) < unit);
}

TEST_CASE("uniform numbers fill their interval evenly and stay in it") {
  Random random(1, 0);
  std::array<int, 10> bins{};
  for (int i = 0; i < 100'000; ++i) {
    const double value = random.uniform(-2.0, 3.0);
    REQUIRE(value >= -2.0);
    REQUIRE(value < 3.0);
    ++bins[static_cast<std::size_t>((value + 2.0) * 2.0)];
    REQUIRE(random.index(7) < 7);
  }
  for (const int count : bins) CHECK(std::abs(count - 10'000) < 500);
}

TEST_CASE("a chance happens as often as it says") {
  Random random(2, 0);
  int count = 0;
  for (int i = 0; i < 100'000; ++i) count += random.chance(0.3) ? 1 : 0;
  CHECK(std::abs(count - 30'000) < 700);
  CHECK_FALSE(random.chance(0.0));
  CHECK(random.chance(1.0));
}

TEST_CASE("seed and stream decide the numbers") {
  Random a(1, 0);
  Random same(1, 0);
  Random other_stream(1, 1);
  Random other_seed(2, 0);
  const double first = a.uniform();
  CHECK(same.uniform() == first);
  CHECK(other_stream.uniform() != first);
  CHECK(other_seed.uniform() != first);
}
