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
using simulation::kModels;
using simulation::kShortDt;
using simulation::Points;
using simulation::Random;
using simulation::uniform;

struct ScanProblem {
  std::string what;
  TargetSet previous;
  TargetSet current;
};

ScanProblem make_problem(const std::string& what, const Points& before, const Points& after,
                         const simulation::Noise& noise, std::uint64_t seed) {
  Random random(seed);
  const Eigen::Vector3d motion(0.8, 0.0, radians(2.0));
  Detections previous =
      simulation::observe_all(before, Eigen::Vector3d::Zero(), kShortDt, {}, noise);
  Detections current = simulation::observe_all(after, motion, kShortDt, {}, noise);
  simulation::perturb(previous, random);
  simulation::perturb(current, random);
  return {what, simulation::targets(previous, {}), simulation::targets(current, {})};
}

Points full_scan(std::uint64_t seed, double min_range_m, double max_range_m, double half_view_rad) {
  Random random(seed);
  return simulation::scatter(random, kMaxDetections, min_range_m, max_range_m, half_view_rad, 0.0);
}

/// Full scans: of one place, of two places, in a dense cluster, and so noisy that all pairs are
/// possible.
std::vector<ScanProblem> full_problems() {
  const simulation::Noise fine{0.1, 0.01, 0.1};
  const Points wide = full_scan(1, 3.0, 80.0, radians(60.0));
  const Points other = full_scan(2, 3.0, 80.0, radians(60.0));
  const Points dense = full_scan(3, 10.0, 14.0, radians(20.0));
  const Points place(kMaxDetections, Eigen::Vector2d(20.0, 3.0));
  return {make_problem("one place", wide, wide, fine, 4),
          make_problem("two places", wide, other, fine, 5),
          make_problem("two places, all ambiguous", dense, full_scan(6, 10.0, 14.0, radians(20.0)),
                       {0.3, 0.02, 0.3}, 7),
          make_problem("dense", dense, dense, {0.1, 0.004, 0.3}, 8),
          make_problem("all one point", place, place, fine, 9),
          make_problem("blurred", wide, wide, {5.0, 0.3, 3.0}, 10)};
}

RegistrationOptions work_options(Likelihood model, int degrees_of_freedom) {
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

/// Largest work of one linearisation of full scans, including the list of pairs.
constexpr std::int64_t kMixtureWork = 256 * (256 + kMaxRayComponents);
constexpr std::int64_t kMaxLinearisationWork =
    kMixtureWork +
    (4 + Association::kMaxRounds) * static_cast<std::int64_t>(Association::kMaxPairs);

TEST_CASE("full scans of any kind stay within the limit on work and are finite") {
  for (const ScanProblem& problem : full_problems()) {
    for (const Likelihood model : kModels) {
      for (const int degrees_of_freedom : {2, 3}) {
        const RegistrationOptions options = work_options(model, degrees_of_freedom);
        Registration registration(options, {});
        registration.set_previous(problem.previous);
        const RegistrationResult result = registration.solve(problem.current, kShortDt);
        CAPTURE(problem.what, model, degrees_of_freedom, result.component_evaluations);
        check_numbers(result);
        CHECK(result.component_evaluations <=
              options.max_component_evaluations + kMaxLinearisationWork);
        CHECK(result.component_evaluations > 0);
      }
    }
  }
}

TEST_CASE("reaching the limit on work is no convergence, and ends soon after") {
  const Points points = full_scan(1, 3.0, 80.0, radians(60.0));
  const ScanProblem problem = make_problem("", points, points, {0.1, 0.01, 0.1}, 2);
  for (const Likelihood model : kModels) {
    for (const int degrees_of_freedom : {2, 3}) {
      RegistrationOptions options = work_options(model, degrees_of_freedom);
      Registration free(options, {});
      free.set_previous(problem.previous);
      const RegistrationResult whole = free.solve(problem.current, kShortDt);
      // Gauss-Newton may not converge on scans as dense as these.
      if (model == Likelihood::exclusive) {
        REQUIRE(whole.status == RegistrationStatus::converged);
      }
      // Less than needed by up to one linearisation.
      for (std::int64_t limit = 0; limit < whole.component_evaluations - kMaxLinearisationWork;
           limit += whole.component_evaluations / 20) {
        options.max_component_evaluations = limit;
        Registration registration(options, {});
        registration.set_previous(problem.previous);
        const RegistrationResult result = registration.solve(problem.current, kShortDt);
        CAPTURE(model, degrees_of_freedom, limit, whole.component_evaluations);
        CHECK(result.status == RegistrationStatus::no_convergence);
        CHECK(result.component_evaluations >= limit);
        CHECK(result.component_evaluations <= limit + kMaxLinearisationWork);
        check_numbers(result);
      }
    }
  }
}

TEST_CASE("reaching the limit on work in a repeated search is no convergence") {
  const Points here = full_scan(1, 3.0, 80.0, radians(60.0));
  const Points there = full_scan(2, 3.0, 80.0, radians(60.0));
  const ScanProblem problem = make_problem("", here, there, {0.1, 0.01, 0.1}, 3);
  const auto solve = [&](std::int64_t limit) {
    RegistrationOptions options = work_options(Likelihood::exclusive, 2);
    options.max_component_evaluations = limit;
    Registration registration(options, {});
    registration.set_previous(problem.previous);
    return registration.solve(problem.current, kShortDt);
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
    CHECK(result.component_evaluations <= limit + kMaxLinearisationWork);
  }
}

TEST_CASE("work is counted for each registration") {
  const Points points = full_scan(1, 3.0, 80.0, radians(60.0));
  const ScanProblem problem = make_problem("", points, points, {0.1, 0.01, 0.1}, 2);
  for (const Likelihood model : kModels) {
    Registration registration(work_options(model, 2), {});
    registration.set_previous(problem.previous);
    const RegistrationResult first = registration.solve(problem.current, kShortDt);
    for (int i = 0; i < 3; ++i) {
      CHECK(registration.solve(problem.current, kShortDt).component_evaluations ==
            first.component_evaluations);
    }
  }
}

TEST_CASE("a registration that reaches the limit on work is independent of earlier ones") {
  Random random(1);
  const Points few = simulation::scatter(random, 10, 3.0, 30.0, radians(60.0), 3.0);
  const Points many = full_scan(2, 3.0, 80.0, radians(60.0));
  const simulation::Noise noise{0.1, 0.01, 0.1};
  const ScanProblem small = make_problem("", few, few, noise, 2);
  const ScanProblem large = make_problem("", few, many, noise, 2);
  RegistrationOptions options = work_options(Likelihood::exclusive, 2);
  options.max_component_evaluations = 4000;
  Registration used(options, {});
  used.set_previous(small.previous);
  REQUIRE(used.solve(small.current, kShortDt).status == RegistrationStatus::converged);
  Registration fresh(options, {});
  fresh.set_previous(large.previous);
  CHECK(fresh.solve(large.current, kShortDt).status == RegistrationStatus::no_convergence);
  CHECK(used.solve(large.current, kShortDt).status == RegistrationStatus::no_convergence);
}

}  // namespace
}  // namespace cremed
