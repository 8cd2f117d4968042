// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/map/map_pairs.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Random;
using simulation::uniform;

Symmetric2 random_information(Random& random) {
  const double xx = uniform(random, 1.0, 30.0);
  const double yy = uniform(random, 1.0, 30.0);
  return {xx, uniform(random, -0.9, 0.9) * std::sqrt(xx * yy), yy};
}

/// Adds pairs with targets of the map within 2 m of the origin.
void add_pairs(MapPairs& pairs, std::size_t count, Random& random) {
  for (std::size_t k = 0; k < count; ++k) {
    const Eigen::Vector2d at(uniform(random, -2.0, 2.0), uniform(random, -2.0, 2.0));
    pairs.add({at, {}, 0.1 * static_cast<double>(k), static_cast<std::uint8_t>(k % 7), -1},
              random_information(random), uniform(random, 0.1, 3.0));
  }
  pairs.pad();
}

TEST_CASE("the sums over a target's pairs are those of each pair by itself") {
  Random random(5);
  const auto pairs = std::make_unique<MapPairs>();
  for (std::size_t count = 0; count < 12; ++count) {
    CAPTURE(count);
    add_pairs(*pairs, 3, random);  // of another target
    const std::size_t begin = pairs->size();
    add_pairs(*pairs, count, random);
    const Eigen::Vector2d at(uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5));
    const PairSums sums = pairs->sum_up(begin, pairs->size(), at);
    PairSums expected;
    for (std::size_t k = begin; k < begin + count; ++k) {
      const Eigen::Vector2d e = at - pairs->at_m(k);
      const Eigen::Vector2d force = pairs->information(k) * e;
      const double w = pairs->weight(k);
      CHECK((w == 0.0) == (force.dot(e) >= 25.0));
      expected.weight += w;
      expected.information = expected.information + w * pairs->information(k);
      expected.force += w * force;
      expected.squared_force =
          expected.squared_force +
          w * Symmetric2{force.x() * force.x(), force.x() * force.y(), force.y() * force.y()};
    }
    CHECK(sums.weight == Approx(expected.weight));
    CHECK(sums.information.xx == Approx(expected.information.xx));
    CHECK(sums.information.xy == Approx(expected.information.xy));
    CHECK(sums.information.yy == Approx(expected.information.yy));
    CHECK(sums.force.x() == Approx(expected.force.x()));
    CHECK(sums.force.y() == Approx(expected.force.y()));
    CHECK(sums.squared_force.xx == Approx(expected.squared_force.xx));
    CHECK(sums.squared_force.xy == Approx(expected.squared_force.xy));
    CHECK(sums.squared_force.yy == Approx(expected.squared_force.yy));
  }
}

TEST_CASE("the weight of a pair is its density") {
  const auto pairs = std::make_unique<MapPairs>();
  pairs->add({Eigen::Vector2d(1.0, 2.0), {}, 0.0, 0, -1}, {4.0, 1.0, 9.0}, 0.7);
  pairs->pad();
  REQUIRE(pairs->size() == MapPairs::kLanes);
  pairs->sum_up(0, pairs->size(), {1.5, 1.8});
  const double squared_distance = 4.0 * 0.25 + 2.0 * 0.5 * -0.2 + 9.0 * 0.04;
  CHECK(pairs->weight(0) == Approx(0.7 * std::exp(-0.5 * squared_distance)));
  for (std::size_t k = 1; k < MapPairs::kLanes; ++k) {
    CHECK(pairs->weight(k) == 0.0);
  }
}

}  // namespace
}  // namespace cremed
