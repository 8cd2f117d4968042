// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/registration/registration.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Detections;
using simulation::Points;
using simulation::Random;
using simulation::uniform;

constexpr double kDt = 0.1;
constexpr std::array kModels = {Likelihood::exclusive, Likelihood::max_sum_mixture};

struct Problem {
  std::string what;
  TargetSet previous;
  TargetSet current;
};

Problem make_problem(const std::string& what, const Points& before, const Points& after,
                     const simulation::Noise& noise, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Vector3d motion(0.8, 0.0, radians(2.0));
  Detections previous = simulation::observe_all(before, Eigen::Vector3d::Zero(), kDt, {}, noise);
  Detections current = simulation::observe_all(after, motion, kDt, {}, noise);
  simulation::perturb(previous, random);
  simulation::perturb(current, random);
  return {what, simulation::targets(previous, {}), simulation::targets(current, {})};
}

Points scatter(std::uint64_t seed, double min_range_m, double max_range_m, double half_view_rad) {
  Random random(seed);
  return simulation::scatter(random, kMaxDetections, min_range_m, max_range_m, half_view_rad, 0.0);
}

/// Full scans: of one place, of two, in a cluster, and so blurred that all pairs are possible.
std::vector<Problem> full_problems() {
  const simulation::Noise fine{0.1, 0.01, 0.1};
  const Points wide = scatter(1, 3.0, 80.0, radians(60.0));
  const Points other = scatter(2, 3.0, 80.0, radians(60.0));
  const Points dense = scatter(3, 10.0, 14.0, radians(20.0));
  const Points place(kMaxDetections, Eigen::Vector2d(20.0, 3.0));
  return {make_problem("one place", wide, wide, fine, 4),
          make_problem("two places", wide, other, fine, 5),
          make_problem("two places, all ambiguous", dense, scatter(6, 10.0, 14.0, radians(20.0)),
                       {0.3, 0.02, 0.3}, 7),
          make_problem("dense", dense, dense, {0.1, 0.004, 0.3}, 8),
          make_problem("all one point", place, place, fine, 9),
          make_problem("blurred", wide, wide, {5.0, 0.3, 3.0}, 10)};
}

RegistrationOptions options_of(Likelihood model, int degrees_of_freedom) {
  RegistrationOptions options;
  options.likelihood = model;
  options.degrees_of_freedom = degrees_of_freedom;
  return options;
}

void check_numbers(const RegistrationResult& result) {
  CHECK(result.status != RegistrationStatus::non_finite);
  CHECK(result.motion.allFinite());
  CHECK(result.covariance.allFinite());
  CHECK(std::isfinite(result.cost));
  if (result.status == RegistrationStatus::converged) {
    CHECK(result.covariance.diagonal().minCoeff() >= 0.0);
    CHECK(result.covariance(0, 0) > 0.0);
  }
}

/// One linearisation of full scans, including the lists of pairs.
constexpr std::int64_t kMixtureWork = 256 * (256 + kMaxRayComponents);
constexpr std::int64_t kMostWork =
    kMixtureWork +
    (4 + Association::kMaxRounds) * static_cast<std::int64_t>(Association::kMaxPairs);

TEST_CASE("full scans of any kind stay within the work allowed and are numbers") {
  for (const Problem& problem : full_problems()) {
    for (const Likelihood model : kModels) {
      for (const int degrees_of_freedom : {2, 3}) {
        const RegistrationOptions options = options_of(model, degrees_of_freedom);
        Registration registration(options, {});
        registration.set_previous(problem.previous);
        const RegistrationResult result = registration.solve(problem.current, kDt);
        CAPTURE(problem.what, model, degrees_of_freedom, result.component_evaluations);
        check_numbers(result);
        CHECK(result.component_evaluations <= options.max_component_evaluations + kMostWork);
        CHECK(result.component_evaluations > 0);
      }
    }
  }
}

TEST_CASE("work that runs out is no convergence, and ends soon after") {
  const Points points = scatter(1, 3.0, 80.0, radians(60.0));
  const Problem problem = make_problem("", points, points, {0.1, 0.01, 0.1}, 2);
  for (const Likelihood model : kModels) {
    for (const int degrees_of_freedom : {2, 3}) {
      RegistrationOptions options = options_of(model, degrees_of_freedom);
      Registration free(options, {});
      free.set_previous(problem.previous);
      const RegistrationResult whole = free.solve(problem.current, kDt);
      // Gauss-Newton may fail in scans as dense as these.
      if (model == Likelihood::exclusive) {
        REQUIRE(whole.status == RegistrationStatus::converged);
      }
      // Up to one linearisation less than needed.
      for (std::int64_t limit = 0; limit < whole.component_evaluations - kMostWork;
           limit += whole.component_evaluations / 20) {
        options.max_component_evaluations = limit;
        Registration registration(options, {});
        registration.set_previous(problem.previous);
        const RegistrationResult result = registration.solve(problem.current, kDt);
        CAPTURE(model, degrees_of_freedom, limit, whole.component_evaluations);
        CHECK(result.status == RegistrationStatus::no_convergence);
        CHECK(result.component_evaluations >= limit);
        CHECK(result.component_evaluations <= limit + kMostWork);
        check_numbers(result);
      }
    }
  }
}

TEST_CASE("work that runs out while searching again is no convergence") {
  const Points here = scatter(1, 3.0, 80.0, radians(60.0));
  const Points there = scatter(2, 3.0, 80.0, radians(60.0));
  const Problem problem = make_problem("", here, there, {0.1, 0.01, 0.1}, 3);
  const auto solve = [&](std::int64_t limit) {
    RegistrationOptions options = options_of(Likelihood::exclusive, 2);
    options.max_component_evaluations = limit;
    Registration registration(options, {});
    registration.set_previous(problem.previous);
    return registration.solve(problem.current, kDt);
  };
  const RegistrationResult whole = solve(1'000'000'000);
  REQUIRE(whole.starts == 5);
  CHECK(whole.status != RegistrationStatus::converged);
  for (const double share : {0.3, 0.5, 0.7, 0.9}) {
    const auto limit =
        static_cast<std::int64_t>(share * static_cast<double>(whole.component_evaluations));
    const RegistrationResult result = solve(limit);
    CAPTURE(share, result.starts, whole.component_evaluations);
    CHECK(result.starts <= whole.starts);
    CHECK(result.status != RegistrationStatus::converged);
    CHECK(result.component_evaluations <= limit + kMostWork);
  }
}

TEST_CASE("work is counted anew for every registration") {
  const Points points = scatter(1, 3.0, 80.0, radians(60.0));
  const Problem problem = make_problem("", points, points, {0.1, 0.01, 0.1}, 2);
  for (const Likelihood model : kModels) {
    Registration registration(options_of(model, 2), {});
    registration.set_previous(problem.previous);
    const RegistrationResult first = registration.solve(problem.current, kDt);
    for (int i = 0; i < 3; ++i) {
      CHECK(registration.solve(problem.current, kDt).component_evaluations ==
            first.component_evaluations);
    }
  }
}

TEST_CASE("where work runs out nothing shows of what was solved before") {
  Random random(1);
  const Points few = simulation::scatter(random, 10, 3.0, 30.0, radians(60.0), 3.0);
  const Points many = scatter(2, 3.0, 80.0, radians(60.0));
  const simulation::Noise noise{0.1, 0.01, 0.1};
  const Problem small = make_problem("", few, few, noise, 2);
  const Problem large = make_problem("", few, many, noise, 2);
  RegistrationOptions options = options_of(Likelihood::exclusive, 2);
  options.max_component_evaluations = 4000;
  Registration used(options, {});
  used.set_previous(small.previous);
  REQUIRE(used.solve(small.current, kDt).status == RegistrationStatus::converged);
  Registration fresh(options, {});
  fresh.set_previous(large.previous);
  CHECK(fresh.solve(large.current, kDt).status == RegistrationStatus::no_convergence);
  CHECK(used.solve(large.current, kDt).status == RegistrationStatus::no_convergence);
}

}  // namespace
}  // namespace cremed
