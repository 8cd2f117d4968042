// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "test/estimator/association_pairs.hpp"
#include "test/estimator/numeric.hpp"

namespace cremed {
namespace {

using simulation::fill;
using simulation::Gradients;
using simulation::make_association;
using simulation::Random;
using simulation::random_ratios;
using simulation::Ratios;
using simulation::uniform;

/// Pairs whose ratios change with a state: log psi(x) = log psi(0) - g x.
struct Pairs {
  Ratios ratios;
  Gradients gradients;
};

Pairs random_problem(Random& random, Eigen::Index rows, Eigen::Index columns, double decades) {
  std::normal_distribution<double> normal;
  Pairs problem{random_ratios(random, rows, columns, decades), {}};
  for (Eigen::Index k = 0; k < rows * columns; ++k) {
    problem.gradients.emplace_back(normal(random), normal(random), normal(random));
  }
  return problem;
}

/// sum_ij p_ij g_ij at a state, from factors that need no further round.
Eigen::Vector3d gradient(Association& association, const Pairs& problem,
                         const Eigen::Vector3d& state) {
  Ratios ratios = problem.ratios;
  for (Eigen::Index k = 0; k < ratios.size(); ++k) {
    const Eigen::Vector3d& g = problem.gradients[static_cast<std::size_t>(k)];
    ratios(k / ratios.cols(), k % ratios.cols()) *= std::exp(-g.dot(state));
  }
  fill(association, ratios, problem.gradients);
  for (int i = 0; i < 100; ++i) {
    association.solve();
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < association.size(); ++k) {
    sum += association.probability(k) * association.gradient(k);
  }
  return sum;
}

Eigen::Matrix3d missing_information(Association& association, const Pairs& problem) {
  fill(association, problem.ratios, problem.gradients);
  association.start();
  association.solve();
  return association.missing_information(Eigen::Vector3d::Ones());
}

Eigen::Matrix3d complete_information(const Association& association) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < association.size(); ++k) {
    const Eigen::Vector3d& g = association.gradient(k);
    sum += association.probability(k) * g * g.transpose();
  }
  return sum;
}

TEST_CASE("missing information is the gradient's derivative by the probabilities") {
  const auto association = make_association();
  Random random(4);
  for (const auto& [rows, columns] : {std::pair{1, 1}, {1, 3}, {3, 1}, {2, 2}, {3, 3}, {2, 4}}) {
    for (int run = 0; run < 100; ++run) {
      const Pairs problem = random_problem(random, rows, columns, 1.0);
      const Eigen::Matrix3d actual = missing_information(*association, problem);
      const double scale = complete_information(*association).norm();
      const Eigen::Matrix3d slope = numeric::central_differences(
          Eigen::Vector3d(Eigen::Vector3d::Zero()), 1e-4,
          [&](const Eigen::Vector3d& x) { return gradient(*association, problem, x); });
      CAPTURE(rows, columns, run);
      CHECK((actual + slope).norm() < 2.0 * Association::kGradientTolerance * scale);
    }
  }
}

/// The smallest eigenvalue of any missing information, relative to the complete one.
double smallest_eigenvalue(double decades) {
  const auto association = make_association();
  Random random(5);
  double smallest = 1.0;
  for (int run = 0; run < 2000; ++run) {
    const auto rows = static_cast<Eigen::Index>(1 + random() % 4);
    const auto columns = static_cast<Eigen::Index>(1 + random() % 4);
    const Eigen::Matrix3d missing =
        missing_information(*association, random_problem(random, rows, columns, decades));
    CHECK(missing == missing.transpose());
    const double least = numeric::eigenvalues(missing).minCoeff();
    smallest = std::min(smallest, least / complete_information(*association).norm());
  }
  return smallest;
}

TEST_CASE("missing information is symmetric and positive semi-definite") {
  CHECK(smallest_eigenvalue(1.5) > -2e-3);
}

TEST_CASE("missing information is positive semi-definite for extreme ratios") {
  CHECK(smallest_eigenvalue(6.0) > -2e-3);
}

}  // namespace
}  // namespace cremed
