// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "tools/laboratory/table/cost_curves.hpp"

using namespace cremed;

namespace {

double lowest_at(const std::vector<CostPoint>& points, double CostPoint::*member) {
  return std::min_element(
             points.begin(), points.end(),
             [&](const CostPoint& a, const CostPoint& b) { return a.*member < b.*member; })
      ->translation_m;
}

}  // namespace

TEST_CASE("The Max-Sum-Mixture is the likelihood, the sum is not") {
  const auto outlier = GENERATE(false, true);
  const auto points = cost_curves(outlier);
  double difference = 0.0;
  double difference_of_sum = 0.0;
  for (const CostPoint& point : points) {
    difference = std::max(difference, std::abs(point.msm - point.likelihood));
    difference_of_sum =
        std::max(difference_of_sum, std::abs(point.sum_approximation - point.likelihood));
  }
  CHECK(difference < 1e-6);
  CHECK(difference_of_sum > 10.0);
}

TEST_CASE("An outlier draws the likelihood away from truth unless it is modelled") {
  CHECK(lowest_at(cost_curves(false), &CostPoint::msm) == Approx(kCurveTruthM).margin(0.1));
  const auto points = cost_curves(true);
  CHECK(std::abs(lowest_at(points, &CostPoint::msm) - kCurveTruthM) > 0.5);
  CHECK(lowest_at(points, &CostPoint::msm_with_ray) == Approx(kCurveTruthM).margin(0.1));
}
