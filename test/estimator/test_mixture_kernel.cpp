// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/cost/mixture.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Random;
using simulation::uniform;

TargetSet random_targets(Random& random, std::size_t count) {
  TargetSet targets;
  for (std::size_t i = 0; i < count; ++i) {
    Detection detection;
    detection.range_m = uniform(random, 2.0, 40.0);
    detection.azimuth_rad = uniform(random, -0.7, 0.7);
    detection.range_std_m = uniform(random, 0.05, 0.5);
    detection.azimuth_std_rad = uniform(random, 0.003, 0.06);
    targets.add(detection, {});
  }
  return targets;
}

std::vector<MixturePoint> random_points(Random& random, std::size_t count) {
  std::vector<MixturePoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double reach_m = i % 5 == 0 ? 1e4 : 40.0;
    const double variance_m2 = uniform(random, 1e-3, 0.5);
    points.push_back({uniform(random, 0.0, reach_m),
                      uniform(random, -20.0, 20.0),
                      {variance_m2, 0.3 * variance_m2, variance_m2}});
  }
  return points;
}

/// Every bit of the residuals, in order.
std::vector<std::uint64_t> bits(const std::vector<MixtureResidual>& residuals) {
  std::vector<std::uint64_t> result;
  for (const MixtureResidual& r : residuals) {
    for (const double value :
         {r.residual[0], r.residual[1], r.residual[2], r.jacobian(0, 0), r.jacobian(0, 1),
          r.jacobian(1, 0), r.jacobian(1, 1), r.jacobian(2, 0), r.jacobian(2, 1), r.cost}) {
      result.push_back(std::bit_cast<std::uint64_t>(value));
    }
    result.push_back(r.component);
  }
  return result;
}

TEST_CASE("all kernels give bit-identical results") {
  const auto kernels = mixture_kernels();
  REQUIRE(kernels.back().name == "plain");
  OutlierRayOptions options;
  options.weight = 0.2;
  const OutlierRay ray(options, {});
  Random random(21);
  for (const std::size_t count : {1U, 2U, 9U, 26U, 27U, 60U, 131U, 256U}) {
    const TargetSet targets = random_targets(random, count);
    const std::vector<MixturePoint> points = random_points(random, 50);
    std::vector<MixtureResidual> expected(points.size());
    const auto plain = std::make_unique<Mixture>(kernels.back().kernel);
    plain->assign(targets, ray);
    plain->evaluate(points, expected);
    for (const NamedMixtureKernel& kernel : kernels) {
      std::vector<MixtureResidual> actual(points.size());
      const auto mixture = std::make_unique<Mixture>(kernel.kernel);
      mixture->assign(targets, ray);
      mixture->evaluate(points, actual);
      CAPTURE(kernel.name, count);
      CHECK(bits(actual) == bits(expected));
    }
  }
}

TEST_CASE("of equally good components the first is returned") {
  TargetSet targets;
  Detection detection;
  detection.range_std_m = 0.2;
  detection.azimuth_std_rad = 0.02;
  for (std::size_t i = 0; i < 100; ++i) {
    detection.range_m = i < 37 ? 30.0 : 10.0;
    targets.add(detection, {});
  }
  const OutlierRay no_ray(OutlierRayOptions{.weight = 0.0}, {});
  for (const NamedMixtureKernel& kernel : mixture_kernels()) {
    const auto mixture = std::make_unique<Mixture>(kernel.kernel);
    mixture->assign(targets, no_ray);
    CAPTURE(kernel.name);
    CHECK(mixture->evaluate({10.1, 0.1}, {0.1, 0.0, 0.1}).component == 37);
    CHECK(mixture->evaluate({30.1, 0.1}, {0.1, 0.0, 0.1}).component == 0);
  }
}

}  // namespace
}  // namespace cremed
