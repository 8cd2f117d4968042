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

/// Calls `use(i, j)` for each product of columns in the lower part of a matrix.
template <typename Use>
void each_product(const std::vector<int>& columns, const Use& use) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (columns[i] >= columns[j]) {
        use(i, j);
      }
    }
  }
}

}  // namespace

double Loss::cost(double square) const {
  const double scale_square = scale * scale;
  switch (kind) {
    case Kind::huber:
      return square <= scale_square ? square : 2.0 * scale * std::sqrt(square) - scale_square;
    case Kind::cauchy:
      return scale_square * std::log1p(square / scale_square);
    case Kind::square:
      break;
  }
  return square;
}

double Loss::weight(double square) const {
  const double scale_square = scale * scale;
  switch (kind) {
    case Kind::huber:
      return square <= scale_square ? 1.0 : scale / std::sqrt(square);
    case Kind::cauchy:
      return scale_square / (scale_square + square);
    case Kind::square:
      break;
  }
  return 1.0;
}

template <typename Use>
double LeastSquares::evaluate(const Use& use) const {
  double cost = 0.0;
  Rows rows;
  RowsJacobian jacobian;
  for (const Term& term : terms_) {
    rows.resize(term.rows);
    jacobian.resize(term.rows, static_cast<Eigen::Index>(term.columns.size()));
    term.evaluate(rows, jacobian);
    const double square = rows.squaredNorm();
    const double root = std::sqrt(term.loss.weight(square));
    cost += 0.5 * term.loss.cost(square);
    rows *= root;
    jacobian *= root;
    use(term, rows, jacobian);
  }
  return cost;
}

LeastSquares::Linearised LeastSquares::linearise() const {
  Linearised result;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> residuals;
  result.cost = evaluate([&](const Term& term, const Rows& rows, const RowsJacobian& jacobian) {
    for (int row = 0; row < term.rows; ++row) {
      const int number = static_cast<int>(residuals.size());
      residuals.push_back(rows[row]);
      for (std::size_t i = 0; i < term.columns.size(); ++i) {
        entries.emplace_back(number, term.columns[i], jacobian(row, static_cast<Eigen::Index>(i)));
      }
    }
  });
  const auto count = static_cast<Eigen::Index>(residuals.size());
  result.residuals = Eigen::Map<const Eigen::VectorXd>(residuals.data(), count);
  result.jacobian.resize(count, count_);
  result.jacobian.setFromTriplets(entries.begin(), entries.end());
  return result;
}

LeastSquares::Pattern LeastSquares::pattern() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Term& term : terms_) {
    each_product(term.columns, [&](std::size_t i, std::size_t j) {
      entries.emplace_back(term.columns[i], term.columns[j], 0.0);
    });
  }
  Pattern pattern{Eigen::SparseMatrix<double>(count_, count_), {}};
  pattern.information.setFromTriplets(entries.begin(), entries.end());
  for (const Eigen::Triplet<double>& entry : entries) {
    const double& value = pattern.information.coeffRef(entry.row(), entry.col());
    pattern.places.push_back(static_cast<int>(&value - pattern.information.valuePtr()));
  }
  return pattern;
}

LeastSquares::NormalEquations LeastSquares::normal_equations(const Pattern& pattern) const {
  NormalEquations result{pattern.information, Eigen::VectorXd::Zero(count_)};
  double* const information = result.information.valuePtr();
  auto place = pattern.places.begin();
  result.cost = evaluate([&](const Term& term, const Rows& rows, const RowsJacobian& jacobian) {
    for (std::size_t i = 0; i < term.columns.size(); ++i) {
      result.gradient[term.columns[i]] += jacobian.col(static_cast<Eigen::Index>(i)).dot(rows);
    }
    each_product(term.columns, [&](std::size_t i, std::size_t j) {
      information[*place++] += jacobian.col(static_cast<Eigen::Index>(i))
                                   .dot(jacobian.col(static_cast<Eigen::Index>(j)));
    });
  });
  return result;
}

Eigen::VectorXd LeastSquares::values() const {
  Eigen::VectorXd values(count_);
  Eigen::Index at = 0;
  for (const Block& block : blocks_) {
    std::copy_n(block.values, block.size, values.data() + at);
    at += static_cast<Eigen::Index>(block.size);
  }
  return values;
}

void LeastSquares::set_values(const Eigen::VectorXd& values) {
  Eigen::Index at = 0;
  for (const Block& block : blocks_) {
    std::copy_n(values.data() + at, block.size, block.values);
    at += static_cast<Eigen::Index>(block.size);
  }
}

void LeastSquares::solve() {
  const Pattern pattern = this->pattern();
  NormalEquations now = normal_equations(pattern);
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;
  factors.analyzePattern(pattern.information);
  double damping = kFirstDamping;
  double increase = kFirstIncrease;
  for (int i = 0; i < kMaxSteps; ++i) {
    Eigen::SparseMatrix<double> damped = now.information;
    damped.diagonal() *= 1.0 + damping;
    factors.factorize(damped);
    const Eigen::VectorXd step = factors.solve(-now.gradient);
    const Eigen::VectorXd before = values();
    set_values(before + step);
    NormalEquations next = normal_equations(pattern);
    const double decrease = now.cost - next.cost;
    const double expected = -step.dot(now.gradient) -
                            0.5 * step.dot(now.information.selfadjointView<Eigen::Lower>() * step);
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
