// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <type_traits>

#include <Eigen/Core>

#include "cremed/estimator/scan/symmetric2.hpp"

namespace cremed::numeric {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

double radians(double degrees);

Eigen::Matrix2d matrix(const Symmetric2& m);

/// Derivative of `function` at `at` in each coordinate, by central differences: one column each.
template <typename Vector, typename Function>
auto central_differences(const Vector& at, double step, const Function& function) {
  using Value = decltype(function(at));
  if constexpr (std::is_same_v<Value, double>) {
    Vector gradient;
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const Vector offset = step * Vector::Unit(i);
      gradient(i) = (function(at + offset) - function(at - offset)) / (2.0 * step);
    }
    return gradient;
  } else {
    Eigen::Matrix<double, Value::RowsAtCompileTime, Vector::RowsAtCompileTime> jacobian;
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      const Vector offset = step * Vector::Unit(i);
      jacobian.col(i) = (function(at + offset) - function(at - offset)) / (2.0 * step);
    }
    return jacobian;
  }
}

/// Squared error in standard deviations of the free states: chi-square with as many degrees of
/// freedom, if the covariance is credible.
double normalised_error(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance,
                        int degrees_of_freedom);

/// Of a symmetric matrix, in increasing order.
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric);

/// An error with this covariance, which may be singular, from one with the unit matrix.
Eigen::VectorXd coloured(const Eigen::VectorXd& white, const Eigen::MatrixXd& covariance);

/// Standard deviation of the mean of n chi-square variables, each divided by its k degrees of
/// freedom.
double anees_deviation(std::size_t n, int degrees_of_freedom);

/// Relative standard deviation of a root mean square of n normal variables.
double rmse_deviation(std::size_t n);

/// Standard deviation of a share p of n.
double share_deviation(double p, std::size_t n);

}  // namespace cremed::numeric
