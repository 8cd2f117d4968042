// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/association.hpp"

#include <algorithm>
#include <cmath>

#include "cremed/estimator/cost/sum_of_logs.hpp"

namespace cremed {
namespace {

/// The root of f^2 + f s = 1 in [0, 1]; see (5) of the README.
double factor_of(double sum) { return 2.0 / (sum + std::sqrt(sum * sum + 4.0)); }

}  // namespace

void Association::clear(std::size_t columns) {
  size_ = 0;
  rows_ = 0;
  row_begin_[0] = 0;
  columns_ = columns;
}

void Association::begin_row() {
  ++rows_;
  row_begin_[rows_] = static_cast<std::uint16_t>(size_);
}

/// Exact for pairs without competitors and for square blocks of equal ratios.
void Association::start() {
  std::fill_n(sum_.begin(), columns_, 0.0);
  for (std::size_t k = 0; k < size_; ++k) {
    sum_[column_of_[k]] += ratio_[k];
  }
  for (std::size_t j = 0; j < columns_; ++j) {
    column_factor_[j] = 1.0 / std::sqrt(1.0 + sum_[j]);
  }
}

/// Scales rows, then columns; returns the largest change of a column's probability.
double Association::scale(bool over_relaxed) {
  const auto next_factor = [over_relaxed](double factor, double sum) {
    const double exact = factor_of(sum);
    return over_relaxed ? std::min(exact * std::sqrt(exact / factor), 1.0) : exact;
  };
  // In separate loops over all pairs, which have no short inner loops with unpredictable ends, and
  // over all rows, which the compiler can vectorise.
  std::fill_n(row_sum_.begin(), rows_, 0.0);
  for (std::size_t k = 0; k < size_; ++k) {
    row_sum_[row_of_[k]] += ratio_[k] * column_factor_[column_of_[k]];
  }
  for (std::size_t i = 0; i < rows_; ++i) {
    row_factor_[i] = next_factor(row_factor_[i], row_sum_[i]);
  }
  std::fill_n(sum_.begin(), columns_, 0.0);
  for (std::size_t k = 0; k < size_; ++k) {
    sum_[column_of_[k]] += ratio_[k] * row_factor_[row_of_[k]];
  }
  for (std::size_t j = 0; j < columns_; ++j) {
    const double next = next_factor(column_factor_[j], sum_[j]);
    change_[j] = std::abs(next - column_factor_[j]) * sum_[j];
    column_factor_[j] = next;
  }
  return *std::max_element(change_.begin(),
                           change_.begin() + static_cast<std::ptrdiff_t>(columns_));
}

int Association::solve(int max_rounds, double tolerance) {
  int rounds = 0;
  double change = 0.0;
  do {
    ++rounds;
    change = scale(rounds > kPlainRounds);
  } while (change > tolerance && rounds < max_rounds);
  is_solved_ = change <= kTolerance || max_rounds >= kMaxRounds;
  if (rounds > kPlainRounds) {
    scale(false);  // after a plain round no column has more than one partner
  }
  for (std::size_t k = 0; k < size_; ++k) {
    probability_[k] = ratio_[k] * row_factor_[row_of_[k]] * column_factor_[column_of_[k]];
  }
  return rounds;
}

double Association::cost() const {
  SumOfLogs sum;  // Factors are between 1e-6 (kMaxRatio) and 1.
  std::for_each_n(row_factor_.begin(), rows_, [&](double factor) { sum.add(factor); });
  std::for_each_n(column_factor_.begin(), columns_, [&](double factor) { sum.add(factor); });
  return sum.value();
}

/// Updates a of all rows from b of the columns; see (7) of the README.
void Association::scale_row_gradients() {
  for (std::size_t i = 0; i < rows_; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weight = 2.0 * row_factor_[i] * row_factor_[i];
    for (std::size_t k = row_begin_[i]; k < row_begin_[i + 1]; ++k) {
      sum += probability_[k] * (gradient_[k] - column_gradient_[column_of_[k]]);
      weight += probability_[k];
    }
    row_gradient_[i] = sum / weight;
  }
}

/// Updates b of all columns from a of the rows; returns the largest change.
double Association::scale_column_gradients(const Eigen::Vector3d& unit) {
  std::fill_n(column_sum_.begin(), columns_, Eigen::Vector3d::Zero());
  for (std::size_t j = 0; j < columns_; ++j) {
    sum_[j] = 2.0 * column_factor_[j] * column_factor_[j];
  }
  for (std::size_t k = 0; k < size_; ++k) {
    column_sum_[column_of_[k]] += probability_[k] * (gradient_[k] - row_gradient_[row_of_[k]]);
    sum_[column_of_[k]] += probability_[k];
  }
  double change = 0.0;
  for (std::size_t j = 0; j < columns_; ++j) {
    const Eigen::Vector3d next = column_sum_[j] / sum_[j];
    change = std::max(change, (next - column_gradient_[j]).cwiseProduct(unit).cwiseAbs().sum());
    column_gradient_[j] = next;
  }
  return change;
}

/// Gauss-Seidel. It ends with the rows, which minimise (7) for given columns: the result is never
/// negative.
Eigen::Matrix3d Association::missing_information(const Eigen::Vector3d& unit) {
  std::fill_n(column_gradient_.begin(), columns_, Eigen::Vector3d::Zero());
  scale_row_gradients();
  for (int round = 1; round < kMaxRounds; ++round) {
    const double change = scale_column_gradients(unit);
    scale_row_gradients();
    if (change <= kGradientTolerance) {
      break;
    }
  }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < size_; ++k) {
    const Eigen::Vector3d rest =
        gradient_[k] - row_gradient_[row_of_[k]] - column_gradient_[column_of_[k]];
    sum.noalias() += probability_[k] * gradient_[k] * rest.transpose();
  }
  return 0.5 * (sum + sum.transpose());
}

}  // namespace cremed
