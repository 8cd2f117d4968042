// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "test/estimator/association_pairs.hpp"
#include "test/estimator/numeric.hpp"

namespace cremed {
namespace {

using simulation::fill;
using simulation::make_association;
using simulation::Random;
using simulation::random_ratios;
using simulation::Ratios;
using simulation::uniform;

using Probabilities = Eigen::MatrixXd;  // 0: no such pair

/// The sum over all one-to-one assignments, computed recursively.
struct Enumeration {
  double total = 0.0;
  Probabilities probabilities;
};

void enumerate(const Ratios& ratios, Eigen::Index row, double weight,
               std::vector<Eigen::Index>& partner, Enumeration& sum) {
  if (row == ratios.rows()) {
    sum.total += weight;
    for (Eigen::Index i = 0; i < row; ++i) {
      if (partner[static_cast<std::size_t>(i)] >= 0) {
        sum.probabilities(i, partner[static_cast<std::size_t>(i)]) += weight;
      }
    }
    return;
  }
  Eigen::Index& own = partner[static_cast<std::size_t>(row)];
  own = -1;
  enumerate(ratios, row + 1, weight, partner, sum);
  for (Eigen::Index j = 0; j < ratios.cols(); ++j) {
    own = -1;
    if (std::find(partner.begin(), partner.begin() + row, j) == partner.begin() + row) {
      own = j;
      enumerate(ratios, row + 1, weight * ratios(row, j), partner, sum);
    }
  }
}

Enumeration enumerate(const Ratios& ratios) {
  Enumeration sum{0.0, Probabilities::Zero(ratios.rows(), ratios.cols())};
  std::vector<Eigen::Index> partner(static_cast<std::size_t>(ratios.rows()), -1);
  enumerate(ratios, 0, 1.0, partner, sum);
  sum.probabilities /= sum.total;
  return sum;
}

Probabilities probabilities(const Association& association, const Ratios& ratios) {
  Probabilities result = Probabilities::Zero(ratios.rows(), ratios.cols());
  for (std::size_t i = 0; i < association.rows(); ++i) {
    for (std::size_t k = association.row_begin(i); k < association.row_begin(i + 1); ++k) {
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(association.column(k))) =
          association.probability(k);
    }
  }
  return result;
}

Probabilities solved(Association& association, const Ratios& ratios) {
  fill(association, ratios);
  association.start();
  CHECK(association.solve() <= Association::kMaxRounds);
  return probabilities(association, ratios);
}

TEST_CASE("a pair without competitors is exact") {
  const auto association = make_association();
  Ratios ratios = Ratios::Zero(12, 14);
  for (Eigen::Index i = 0; i < ratios.rows(); ++i) {
    ratios(i, (5 * i + 2) % 14) = std::pow(10.0, static_cast<double>(i) - 4.0);
  }
  const Probabilities actual = solved(*association, ratios);
  double cost = 0.0;
  for (Eigen::Index i = 0; i < ratios.rows(); ++i) {
    const double ratio = ratios.row(i).sum();
    CHECK(actual.row(i).sum() == Approx(ratio / (1.0 + ratio)).epsilon(1e-9));
    cost -= std::log1p(ratio);
  }
  CHECK(association->cost() == Approx(cost));
}

TEST_CASE("in a block of equal ratios all pairs are equally likely") {
  const auto association = make_association();
  for (const Eigen::Index n : {1, 2, 3, 4}) {
    for (const double ratio : {1e-3, 1.0, 1e3, 1e6, 1e11}) {
      CAPTURE(n, ratio);
      const Ratios ratios = Ratios::Constant(n, n, ratio);
      const Probabilities actual = solved(*association, ratios);
      const double expected = ratio / (1.0 + static_cast<double>(n) * ratio);
      CHECK((actual.array() - expected).abs().maxCoeff() < 1e-9);
      if (ratio != 1.0) {  // at 1 it is an approximation only
        CHECK((actual - enumerate(ratios).probabilities).cwiseAbs().maxCoeff() < 3e-4);
      }
    }
  }
}

TEST_CASE("probabilities approximate those of the sum over all assignments") {
  struct Row {
    std::string what;
    Eigen::Index rows, columns;
    bool is_cross;  // one row and one column compete, all others do not
    double max_error, mean_error, max_cost_error;
  };
  // Measured: 0.152 0.036 0.67, 0.218 0.043 1.24, 0.093 0.027 0.40 (both stars), 0.151 0.012 0.74
  const std::vector<Row> rows = {{"2x2", 2, 2, false, 0.17, 0.040, 0.75},
                                 {"3x3", 3, 3, false, 0.24, 0.047, 1.35},
                                 {"star of a row", 1, 3, false, 0.105, 0.031, 0.45},
                                 {"star of a column", 3, 1, false, 0.105, 0.031, 0.45},
                                 {"cross", 4, 4, true, 0.17, 0.014, 0.82}};
  const auto association = make_association();
  Random random(1);
  constexpr int kRuns = 2000;
  for (const Row& row : rows) {
    double max_error = 0.0;
    double sum_error = 0.0;
    double max_cost_error = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      Ratios ratios = random_ratios(random, row.rows, row.columns, 2.0);
      if (row.is_cross) {
        ratios.bottomRightCorner(row.rows - 1, row.columns - 1).setZero();
      }
      const Enumeration expected = enumerate(ratios);
      const Eigen::ArrayXXd error =
          (solved(*association, ratios) - expected.probabilities).cwiseAbs().array();
      max_error = std::max(max_error, error.maxCoeff());
      sum_error += error.mean();
      max_cost_error =
          std::max(max_cost_error, std::abs(association->cost() + std::log(expected.total)));
    }
    CAPTURE(row.what);
    CHECK(max_error < row.max_error);
    CHECK(sum_error / kRuns < row.mean_error);
    CHECK(max_cost_error < row.max_cost_error);
  }
}

TEST_CASE("two targets that compete for two share them, unlike a mixture's rows") {
  const auto association = make_association();
  Ratios ratios(2, 2);
  ratios << 1000.0, 100.0, 1000.0, 100.0;  // both rows are nearer to the first
  const Probabilities exact = enumerate(ratios).probabilities;
  const Probabilities actual = solved(*association, ratios);
  CHECK((actual - exact).cwiseAbs().maxCoeff() < 0.03);
  CHECK((actual.array() - 0.5).abs().maxCoeff() < 0.03);
}

/// The largest sum of a row and of a column over random blocks.
Eigen::Vector2d largest_sums(double decades, Eigen::Index max_size, int runs) {
  const auto association = make_association();
  Random random(2);
  Eigen::Vector2d largest = Eigen::Vector2d::Zero();
  for (int run = 0; run < runs; ++run) {
    const auto rows = static_cast<Eigen::Index>(1 + random() % static_cast<unsigned>(max_size));
    const auto columns = static_cast<Eigen::Index>(1 + random() % static_cast<unsigned>(max_size));
    const Probabilities actual =
        solved(*association, random_ratios(random, rows, columns, decades));
    REQUIRE(actual.minCoeff() >= 0.0);
    largest = largest.cwiseMax(
        Eigen::Vector2d(actual.rowwise().sum().maxCoeff(), actual.colwise().sum().maxCoeff()));
  }
  return largest;
}

TEST_CASE("no target has more than one partner") {
  const Eigen::Vector2d sums = largest_sums(2.0, 8, 2000);
  CHECK(sums.x() <= 1.015);
  CHECK(sums.y() <= 1.0 + 1e-12);
}

TEST_CASE("no target has more than one partner in a partly hidden cluster") {
  const auto association = make_association();
  double largest = 0.0;
  for (const auto& [rows, columns] : {std::pair{2, 3}, {3, 4}, {4, 6}, {3, 2}, {1, 5}, {5, 2}}) {
    for (const double ratio : {1e2, 1e4, 1e6, 1e8}) {
      const Probabilities actual = solved(*association, Ratios::Constant(rows, columns, ratio));
      largest =
          std::max({largest, actual.rowwise().sum().maxCoeff(), actual.colwise().sum().maxCoeff()});
    }
  }
  CHECK(largest <= 1.015);
}

TEST_CASE("the solution does not depend on the start of the factors") {
  const auto association = make_association();
  Random random(3);
  for (int run = 0; run < 300; ++run) {
    const Ratios ratios = random_ratios(random, 5, 5, 1.5);
    const Probabilities cold = solved(*association, ratios);
    // Warm start: factors of other ratios, small and large.
    for (const double decades : {-4.0, 4.0}) {
      fill(*association, ratios * std::pow(10.0, decades));
      association->solve();
      fill(*association, ratios);
      int rounds = 0;
      for (int i = 0; i < 5; ++i) {
        rounds = association->solve();
      }
      REQUIRE(rounds == 1);
      CHECK((probabilities(*association, ratios) - cold).cwiseAbs().maxCoeff() < 5e-3);
    }
  }
}

TEST_CASE("a full association leaves out further pairs and remains usable") {
  const auto association = make_association();
  association->clear(kMaxDetections);
  std::size_t added = 0;
  for (std::size_t i = 0; i < kMaxDetections; ++i) {
    association->begin_row();
    for (std::size_t j = 0; j < 20; ++j) {
      const Eigen::Vector3d gradient = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(j % 3));
      added += association->add((i + j) % kMaxDetections, 1e4, gradient) ? 1U : 0U;
    }
  }
  CHECK(added == Association::kMaxPairs);
  CHECK(association->size() == Association::kMaxPairs);
  CHECK(association->rows() == kMaxDetections);
  association->start();
  association->solve();
  CHECK(std::isfinite(association->cost()));
  CHECK(association->missing_information(Eigen::Vector3d::Ones()).allFinite());
  // clear() removes all pairs.
  Ratios one = Ratios::Zero(2, 2);
  one(1, 0) = 3.0;
  CHECK(solved(*association, one)(1, 0) == Approx(0.75));
  CHECK(association->cost() == Approx(-std::log(4.0)));
}

TEST_CASE("without pairs cost and missing information are zero") {
  const auto association = make_association();
  for (const std::size_t size : {std::size_t{0}, kMaxDetections}) {
    association->clear(size);
    for (std::size_t i = 0; i < size; ++i) {
      association->begin_row();
    }
    association->start();
    CHECK(association->solve() == 1);
    CHECK(association->cost() == 0.0);
    CHECK(association->missing_information(Eigen::Vector3d::Ones()).isZero(0.0));
  }
}

TEST_CASE("a NaN ratio makes the cost NaN, an infinite one is certain") {
  const auto association = make_association();
  Ratios ratios = Ratios::Constant(3, 3, 2.0);
  ratios(1, 2) = numeric::kNan;
  fill(*association, ratios);
  association->start();
  CHECK(association->solve() <= Association::kMaxRounds);
  CHECK(std::isnan(association->cost()));
  association->missing_information(Eigen::Vector3d::Ones());  // terminates

  const Probabilities certain = solved(*association, Ratios::Constant(1, 1, numeric::kInfinity));
  CHECK(certain(0, 0) == Approx(1.0).epsilon(1e-9));
  CHECK(std::isfinite(association->cost()));
}

}  // namespace
}  // namespace cremed
