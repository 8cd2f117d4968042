// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/registration/registration.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/scenario.hpp"

namespace cremed {
namespace {

using numeric::kInfinity;
using numeric::kNan;
using numeric::radians;
using simulation::Detections;
using simulation::kDt;
using simulation::kModels;
using simulation::kStill;
using simulation::paper_options;
using simulation::Points;
using simulation::Random;
using simulation::see;
using simulation::solve;
using simulation::uniform;

TEST_CASE("targets in one place do not observe three states") {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Points one = simulation::scatter(random, 1, 2.0, 100.0, radians(60.0), 0.0);
    const Points many(static_cast<std::size_t>(1 + i % 20), one[0]);
    for (const double weight : {0.0, 0.2}) {
      for (const Likelihood model : kModels) {
        RegistrationOptions options = paper_options(3, i % 2 == 0, model);
        options.outlier_ray.weight = weight;
        const RegistrationResult result =
            solve(options, see(many, kStill), see(many, {0.1, 0.0, 0.01}));
        CAPTURE(one[0].transpose(), many.size(), weight, model);
        // With a ray every component adds a little curvature in all directions.
        const bool is_honest = result.status == RegistrationStatus::degenerate ||
                               (weight > 0.0 && result.covariance.trace() > 1.0);
        CHECK(is_honest);
      }
    }
  }
}

TEST_CASE("without targets nothing is observable") {
  const Points some = {{10.0, 1.0}, {20.0, -4.0}};
  for (const Likelihood model : kModels) {
    for (const int degrees_of_freedom : {2, 3}) {
      RegistrationOptions options = paper_options(degrees_of_freedom, true, model);
      CHECK(solve(options, see(some, kStill), {}).status == RegistrationStatus::degenerate);
      // Not evaluated: no_convergence is also correct.
      options.max_iterations = 0;
      CHECK(solve(options, see(some, kStill), {}).status != RegistrationStatus::converged);
    }
  }
}

TEST_CASE("few targets and targets in a line are solved within their covariance") {
  Random random(2);
  struct Row {
    int degrees_of_freedom;
    Points points;
  };
  const std::vector<Row> rows = {
      {2, {{15.0, 3.0}}},
      {2, {{15.0, 3.0}, {15.0, 3.0}, {15.0, 3.0}}},
      {2, {{8.0, 0.0}, {16.0, 0.0}, {24.0, 0.0}, {32.0, 0.0}}},
      {3, {{15.0, 3.0}, {20.0, -8.0}}},
      {3, {{8.0, 0.0}, {16.0, 0.0}, {24.0, 0.0}, {32.0, 0.0}}},
      {3, {{15.0, -9.0}, {15.0, -3.0}, {15.0, 3.0}, {15.0, 9.0}}},
  };
  constexpr int kRuns = 300;
  for (const Row& row : rows) {
    int inside = 0;
    for (int i = 0; i < kRuns; ++i) {
      const double side_m = row.degrees_of_freedom == 2 ? 0.0 : uniform(random, -0.2, 0.2);
      const Eigen::Vector3d motion{uniform(random, -0.3, 0.3), side_m,
                                   uniform(random, -0.05, 0.05)};
      Detections previous = see(row.points, kStill);
      Detections current = see(row.points, motion);
      simulation::perturb(previous, random);
      simulation::perturb(current, random);
      const RegistrationResult result =
          solve(paper_options(row.degrees_of_freedom, true), previous, current);
      REQUIRE(result.status == RegistrationStatus::converged);
      const double limit = row.degrees_of_freedom == 2 ? 9.21 : 11.34;  // 99 %
      inside += numeric::normalised_error(result.motion - motion, result.covariance,
                                          row.degrees_of_freedom) <= limit
                    ? 1
                    : 0;
    }
    CAPTURE(row.degrees_of_freedom, row.points.size());
    CHECK(inside >= kRuns * 0.95);
  }
}

/// Squared length of the next step at the end of a registration without Doppler, in standard
/// deviations; 0 unless it has converged.
double step_left(const RegistrationOptions& options, const TargetSet& previous,
                 const TargetSet& current) {
  Registration registration(options, {});
  registration.set_previous(previous);
  const RegistrationResult result = registration.solve(current, kDt);
  if (result.status != RegistrationStatus::converged) {
    return 0.0;
  }
  Eigen::Vector3d gradient = simulation::mixture_cost(options, {}, previous, current, kDt)
                                 ->linearise({result.motion})
                                 .gradient;
  if (options.likelihood == Likelihood::exclusive) {
    const auto likelihood = std::make_unique<ExclusiveLikelihood>();
    likelihood->assign(previous, current, OutlierRay(options.outlier_ray, {}));
    likelihood->list_pairs(previous, current, result.motion);
    gradient = likelihood->linearise(previous, current, result.motion).gradient;
  }
  return gradient.dot(result.covariance * gradient);
}

TEST_CASE("converged means that the next step is within the tolerance") {
  for (const Likelihood model : kModels) {
    for (const double weight : {0.0, 0.2}) {
      Random random(5);
      RegistrationOptions options = paper_options(2, false, model);
      options.outlier_ray.weight = weight;
      double largest = 0.0;
      for (int i = 0; i < 200; ++i) {
        const Points here = simulation::scatter(random, 12, 2.5, 37.5, radians(40.0), 0.0);
        // The same place or another.
        const Points there =
            i % 2 == 0 ? here : simulation::scatter(random, 12, 2.5, 37.5, radians(40.0), 0.0);
        const TargetSet previous = simulation::targets(see(here, kStill), {});
        const TargetSet current = simulation::targets(see(there, {0.2, 0.0, 0.05}), {});
        largest = std::max(largest, step_left(options, previous, current));
      }
      CAPTURE(model, weight);
      CHECK(largest < 0.1);
    }
  }
}

constexpr std::array kFields = {&Detection::range_m,         &Detection::azimuth_rad,
                                &Detection::doppler_mps,     &Detection::range_std_m,
                                &Detection::azimuth_std_rad, &Detection::doppler_std_mps};

/// Number of undetected NaN targets, each alone in an otherwise valid scan.
int count_unseen(Likelihood model, bool is_previous) {
  Random random(6);
  const Points points = simulation::scatter(random, 12, 5.0, 30.0, radians(40.0), 3.0);
  const Detections previous = see(points, kStill);
  const Detections current = see(points, {0.2, 0.0, 0.02});
  const auto is_seen = [&](const Detections& broken) {
    const RegistrationResult result = is_previous
                                          ? solve(paper_options(2, true, model), broken, current)
                                          : solve(paper_options(2, true, model), previous, broken);
    return result.status == RegistrationStatus::non_finite;
  };
  int unseen = 0;
  for (const auto field : kFields) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      Detections broken = is_previous ? previous : current;
      broken[i].*field = kNan;
      unseen += is_seen(broken) ? 0 : 1;
    }
  }
  Detections huge = is_previous ? previous : current;
  huge[3].range_m = 1e200;
  return unseen + (is_seen(huge) ? 0 : 1);
}

TEST_CASE("a NaN target of the previous scan is detected") {
  for (const Likelihood model : kModels) {
    CHECK(count_unseen(model, true) == 0);
  }
}

TEST_CASE("a NaN target of the current scan is detected by the mixture") {
  CHECK(count_unseen(Likelihood::max_sum_mixture, false) == 0);
}

TEST_CASE("a NaN target of the current scan is detected") {
  CHECK(count_unseen(Likelihood::exclusive, false) == 0);
}

TEST_CASE("a NaN time ends as non_finite") {
  Random random(6);
  const Points points = simulation::scatter(random, 12, 5.0, 30.0, radians(40.0), 3.0);
  for (const Likelihood model : kModels) {
    for (const double dt_s : {kNan, kInfinity}) {
      CHECK(solve(paper_options(2, true, model), see(points, kStill), see(points, {0.2, 0.0, 0.02}),
                  dt_s)
                .status == RegistrationStatus::non_finite);
    }
  }
}

TEST_CASE("reaching the limit on steps is no convergence; steps count over both stages") {
  Random random(8);
  const Points points = simulation::scatter(random, 25, 5.0, 35.0, radians(50.0), 3.0);
  Detections previous = see(points, kStill);
  Detections current = see(points, {0.4, 0.0, radians(10.0)});
  simulation::perturb(previous, random);
  simulation::perturb(current, random);
  RegistrationOptions options = paper_options(2, true);
  options.max_iterations = 0;
  const RegistrationResult stopped = solve(options, previous, current);
  CHECK(stopped.status == RegistrationStatus::no_convergence);
  CHECK(stopped.iterations >= 1);
  CHECK(stopped.iterations <= Registration::kMaxStartIterations);
  CHECK(stopped.covariance(0, 0) > 0.0);
  options.max_iterations = 1;
  CHECK(solve(options, previous, current).iterations == stopped.iterations + 1);
  options.start_scale = 1.0;
  const RegistrationResult first = solve(options, previous, current);
  CHECK(first.status == RegistrationStatus::no_convergence);
  CHECK(first.iterations == 1);
  const RegistrationResult free = solve(paper_options(2, true), previous, current);
  CHECK(free.status == RegistrationStatus::converged);
  CHECK(free.iterations > 2);
}

TEST_CASE("of several starts the one with the lowest cost is used, in any order") {
  Random random(10);
  const Points points = simulation::scatter(random, 40, 5.0, 60.0, radians(50.0), 1.0);
  const Eigen::Vector3d motion(8.0, 0.0, 0.02);
  const TargetSet current = simulation::targets(see(points, motion), {});
  Registration registration(paper_options(2, true), {});
  registration.set_previous(simulation::targets(see(points, kStill), {}));
  const auto is_found = [&](const RegistrationResult& result) {
    return result.status == RegistrationStatus::converged && (result.motion - motion).norm() < 0.01;
  };
  const Eigen::Vector3d far(-6.0, 0.0, 0.0);
  const Eigen::Vector3d near(7.8, 0.0, 0.0);
  CHECK_FALSE(is_found(registration.solve(current, kDt)));
  CHECK_FALSE(is_found(registration.solve(current, kDt, std::array{kStill, far})));
  CHECK(is_found(registration.solve(current, kDt, std::array{near})));
  CHECK(is_found(registration.solve(current, kDt, std::array{near, kStill, far})));
  CHECK(is_found(registration.solve(current, kDt, std::array{kStill, near, far})));
  CHECK(is_found(registration.solve(current, kDt, std::array{kStill, far, near})));
}

TEST_CASE("a prediction in the right basin needs no first stage") {
  Random random(10);
  const Points points = simulation::scatter(random, 40, 5.0, 60.0, radians(50.0), 1.0);
  const Eigen::Vector3d motion(0.8, 0.0, 0.02);
  const TargetSet current = simulation::targets(see(points, motion), {});
  Registration registration(paper_options(2, true), {});
  registration.set_previous(simulation::targets(see(points, kStill), {}));
  const std::array starts{kStill};
  const Eigen::Vector3d limits(0.1, 0.1, 0.05);
  const RegistrationResult searched = registration.solve(current, kDt, starts);
  const Eigen::Vector3d near(0.78, 0.0, 0.015);
  const RegistrationResult refined =
      registration.solve(current, kDt, starts, PredictedMotion{near, {near, limits}});
  REQUIRE(refined.status == RegistrationStatus::converged);
  CHECK((refined.motion - searched.motion).norm() < 1e-4);
  CHECK(refined.component_evaluations < searched.component_evaluations / 2);

  SECTION("one in another basin is searched for") {
    const Eigen::Vector3d far(-3.0, 0.0, -0.3);
    const RegistrationResult other =
        registration.solve(current, kDt, starts, PredictedMotion{far, {far, limits}});
    CHECK((other.motion - searched.motion).norm() < 1e-4);
    CHECK(other.component_evaluations > searched.component_evaluations);
  }
  SECTION("a result that departs too far from the motion before is searched for") {
    const Eigen::Vector3d before(0.3, 0.0, 0.02);
    const RegistrationResult other =
        registration.solve(current, kDt, starts, PredictedMotion{near, {before, limits}});
    CHECK((other.motion - searched.motion).norm() < 1e-4);
    CHECK(other.component_evaluations > searched.component_evaluations);
  }
}

TEST_CASE("few matches are searched for from other yaw angles, unless the motion was expected") {
  Random random(12);
  const Points seen_twice = simulation::scatter(random, 12, 5.0, 60.0, radians(50.0), 1.0);
  Points before = simulation::scatter(random, 20, 5.0, 60.0, radians(50.0), 1.0);
  Points after = simulation::scatter(random, 20, 5.0, 60.0, radians(50.0), 1.0);
  before.insert(before.end(), seen_twice.begin(), seen_twice.end());
  after.insert(after.end(), seen_twice.begin(), seen_twice.end());
  const Eigen::Vector3d motion(0.8, 0.0, 0.02);
  const TargetSet current = simulation::targets(see(after, motion), {});
  Registration registration(paper_options(2, true), {});
  registration.set_previous(simulation::targets(see(before, kStill), {}));
  const std::array starts{kStill};
  const Eigen::Vector3d limits(0.1, 0.1, 0.05);
  CHECK(registration.solve(current, kDt, starts).starts == 5);
  const RegistrationResult expected =
      registration.solve(current, kDt, starts, PredictedMotion{motion, {motion, limits}});
  CHECK(expected.starts == 1);
  CHECK((expected.motion - motion).norm() < 0.02);
}

TEST_CASE("an exact start takes no step") {
  Random random(9);
  const Points points = simulation::scatter(random, 25, 5.0, 35.0, radians(50.0), 6.0);
  const TargetSet targets = simulation::targets(see(points, kStill), {});
  for (const double start_scale : {1.0, 6.0}) {
    RegistrationOptions options = paper_options(3, true);
    options.start_scale = start_scale;
    options.start_doppler_scale = 2.0;
    Registration registration(options, {});
    registration.set_previous(targets);
    const RegistrationResult result = registration.solve(targets, kDt);
    CHECK(result.status == RegistrationStatus::converged);
    CHECK(result.iterations <= 2);
    CHECK(result.motion.norm() < 1e-4);
  }
}

}  // namespace
}  // namespace cremed
