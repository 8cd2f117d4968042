// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <unsupported/Eigen/AutoDiff>

namespace cremed {

/// What a squared residual costs: quadratic near zero, less beyond `scale`. Least squares by
/// default.
struct Loss {
  enum class Kind { huber, cauchy };
  Kind kind = Kind::huber;
  double scale = std::numeric_limits<double>::infinity();

  [[nodiscard]] double cost(double square) const;
  /// Derivative of the cost.
  [[nodiscard]] double weight(double square) const;
};

/// Nonlinear least squares of many terms with few unknowns each (Levenberg-Marquardt), derivatives
/// by automatic differentiation. Unknowns are the caller's arrays, which solve() changes.
class LeastSquares {
 public:
  /// Columns of the Jacobian, in the order of the calls.
  template <std::size_t N>
  void add_unknowns(std::array<double, N>& values) {
    columns_[values.data()] = static_cast<int>(unknowns_.size());
    for (double& value : values) {
      unknowns_.push_back(&value);
    }
  }

  /// `residual(const T* block, ..., T* rows)` has Rows rows and depends on these unknowns.
  template <int Rows, typename Residual, std::size_t... N>
  void add(const Residual& residual, Loss loss, std::array<double, N>&... unknowns);

  /// Throws std::runtime_error if there is no solution.
  void solve();

  struct Linearised {
    Eigen::SparseMatrix<double, Eigen::RowMajor> jacobian;
    Eigen::VectorXd residuals;
    double cost = 0.0;
  };
  /// At the present values, weighted by the losses.
  [[nodiscard]] Linearised linearise() const;

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1>;
  using RowsJacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  struct Term {
    int rows;
    Loss loss;
    std::vector<int> columns;
    std::function<void(Rows&, RowsJacobian&)> evaluate;
  };
  [[nodiscard]] Eigen::VectorXd values() const;
  void set_values(const Eigen::VectorXd& values);

  std::vector<Term> terms_;
  std::vector<double*> unknowns_;
  std::map<const double*, int> columns_;  // First of an array.
};

template <int Rows, typename Residual, std::size_t... N>
void LeastSquares::add(const Residual& residual, Loss loss, std::array<double, N>&... unknowns) {
  constexpr int kUnknowns = static_cast<int>((N + ...));
  using Derivatives = Eigen::Matrix<double, kUnknowns, 1>;
  using Variable = Eigen::AutoDiffScalar<Derivatives>;
  Term term{Rows, loss, {}, {}};
  const auto add_columns = [&](const auto& block) {
    for (std::size_t i = 0; i < block.size(); ++i) {
      term.columns.push_back(columns_.at(block.data()) + static_cast<int>(i));
    }
  };
  (add_columns(unknowns), ...);
  term.evaluate = [residual, blocks = std::tuple(unknowns.data()...)](auto& values,
                                                                      auto& jacobian) {
    int next = 0;
    const auto variables = [&next]<std::size_t M>(const double* block,
                                                  std::integral_constant<std::size_t, M>) {
      std::array<Variable, M> result;
      for (std::size_t i = 0; i < M; ++i) {
        result[i] = Variable(block[i], kUnknowns, next++);
      }
      return result;
    };
    std::array<Variable, Rows> rows;
    std::apply(
        [&](const auto*... block) {
          const std::tuple all{variables(block, std::integral_constant<std::size_t, N>())...};
          std::apply([&](const auto&... array) { residual(array.data()..., rows.data()); }, all);
        },
        blocks);
    for (int row = 0; row < Rows; ++row) {
      values[row] = rows[static_cast<std::size_t>(row)].value();
      jacobian.row(row) = rows[static_cast<std::size_t>(row)].derivatives().transpose();
    }
  };
  terms_.push_back(std::move(term));
}

}  // namespace cremed
