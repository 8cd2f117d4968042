// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/cost/exponentiate.hpp"
#include "cremed/estimator/cost/vector_math.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using Pack = vector_math::Pack<2>;
using Double = Pack::Double;
using simulation::Random;
using simulation::uniform;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Double both(double x) { return Double{} + x; }

double relative_error(double actual, long double expected) {
  return static_cast<double>(std::abs((static_cast<long double>(actual) - expected) / expected));
}

TEST_CASE("the exponential is exact to a few units in the last place, down to exp(-600)") {
  Random random(31);
  for (int i = 0; i < 20000; ++i) {
    const double x = -std::pow(10.0, uniform(random, -12.0, 2.778));
    CAPTURE(x);
    const Double y = vector_math::exponential<Pack>(both(x));
    REQUIRE(relative_error(y[0], std::exp(static_cast<long double>(x))) < 2.5 * kEpsilon);
    REQUIRE(y[1] == y[0]);
  }
  CHECK(vector_math::exponential<Pack>(both(0.0))[0] == 1.0);
  CHECK(vector_math::exponential<Pack>(both(-1e300))[0] ==
        vector_math::exponential<Pack>(both(-600.0))[0]);
}

TEST_CASE("exponentials of any number of values are those of each") {
  Random random(34);
  for (std::size_t size = 0; size < 20; ++size) {
    std::vector<double> values(size);
    for (double& value : values) {
      value = -std::pow(10.0, uniform(random, -3.0, 3.0));
    }
    std::vector<double> expected;
    for (const double value : values) {
      expected.push_back(vector_math::exponential<Pack>(both(value))[0]);
    }
    exponentiate(values);
    CHECK(values == expected);
  }
}

TEST_CASE("the sum has every lane of every vector") {
  for (std::size_t lane = 0; lane < 8; ++lane) {
    std::array<Double, 4> v{both(3.0), both(3.0), both(3.0), both(3.0)};
    v[lane / 2][lane % 2] = 1.0;
    CAPTURE(lane);
    CHECK(vector_math::sum(v) == 22.0);
  }
}

}  // namespace
}  // namespace cremed
