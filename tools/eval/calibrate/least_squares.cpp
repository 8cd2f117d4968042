// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/calibrate/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/SparseCholesky>

namespace cremed {
namespace {

constexpr int kMaxSteps = 50;
/// Relative change of the cost at which the search ends.
constexpr double kTolerance = 1e-6;
/// Weight of the information's diagonal in the first step, least decrease of the cost for a step,
/// relative to the expected one, and the factors on the weight after it.
constexpr double kFirstDamping = 1e-4;
constexpr double kLeastGain = 1e-3;
constexpr double kMostDecrease = 3.0;
constexpr double kFirstIncrease = 2.0;

/// H. B. Nielsen, Damping Parameter in Marquardt's Method, 1999.
double damping_factor(double gain) {
  return std::max(1.0 / kMostDecrease, 1.0 - std::pow(2.0 * gain - 1.0, 3));
}

}  // namespace

double Loss::cost(double square) const {
  const double scale_square = scale * scale;
  if (kind == Kind::cauchy) {
    return scale_square * std::log1p(square / scale_square);
  }
  return square <= scale_square ? square : 2.0 * scale * std::sqrt(square) - scale_square;
}

double Loss::weight(double square) const {
  const double scale_square = scale * scale;
  if (kind == Kind::cauchy) {
    return scale_square / (scale_square + square);
  }
  return square <= scale_square ? 1.0 : scale / std::sqrt(square);
}

LeastSquares::Linearised LeastSquares::linearise() const {
  Linearised result;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> residuals;
  Rows rows;
  RowsJacobian jacobian;
  for (const Term& term : terms_) {
    rows.resize(term.rows);
    jacobian.resize(term.rows, static_cast<Eigen::Index>(term.columns.size()));
    term.evaluate(rows, jacobian);
    const double square = rows.squaredNorm();
    const double root = std::sqrt(term.loss.weight(square));
    result.cost += 0.5 * term.loss.cost(square);
    for (int row = 0; row < term.rows; ++row) {
      const int number = static_cast<int>(residuals.size());
      residuals.push_back(root * rows[row]);
      for (std::size_t i = 0; i < term.columns.size(); ++i) {
        entries.emplace_back(number, term.columns[i],
                             root * jacobian(row, static_cast<Eigen::Index>(i)));
      }
    }
  }
  const auto count = static_cast<Eigen::Index>(residuals.size());
  result.residuals = Eigen::Map<const Eigen::VectorXd>(residuals.data(), count);
  result.jacobian.resize(count, static_cast<Eigen::Index>(unknowns_.size()));
  result.jacobian.setFromTriplets(entries.begin(), entries.end());
  return result;
}

Eigen::VectorXd LeastSquares::values() const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(unknowns_.size()));
  std::ranges::transform(unknowns_, values.data(), [](const double* unknown) { return *unknown; });
  return values;
}

void LeastSquares::set_values(const Eigen::VectorXd& values) {
  const double* value = values.data();
  for (double* const unknown : unknowns_) {
    *unknown = *value++;
  }
}

void LeastSquares::solve() {
  Linearised now = linearise();
  double damping = kFirstDamping;
  double increase = kFirstIncrease;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver;
  for (int i = 0; i < kMaxSteps; ++i) {
    const Eigen::SparseMatrix<double> information = now.jacobian.transpose() * now.jacobian;
    const Eigen::VectorXd gradient = now.jacobian.transpose() * now.residuals;
    Eigen::SparseMatrix<double> damped = information;
    damped.diagonal() *= 1.0 + damping;
    if (i == 0) {
      solver.analyzePattern(damped);
    }
    solver.factorize(damped);
    const Eigen::VectorXd step = solver.solve(-gradient);
    const Eigen::VectorXd before = values();
    set_values(before + step);
    Linearised next = linearise();
    const double decrease = now.cost - next.cost;
    const double expected = -step.dot(gradient) - 0.5 * step.dot(information * step);
    const bool is_there = std::abs(decrease) <= kTolerance * now.cost;
    if (is_there || !(decrease > kLeastGain * expected)) {
      set_values(before);
      damping *= std::exchange(increase, 2.0 * increase);
    } else {
      now = std::move(next);
      damping *= damping_factor(decrease / expected);
      increase = kFirstIncrease;
    }
    if (is_there) {
      break;
    }
  }
  if (!std::isfinite(now.cost)) {
    throw std::runtime_error("the calibration has no solution");
  }
}

}  // namespace cremed
