// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed::numeric {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double radians(double degrees) { return degrees * 3.1415926535897932 / 180.0; }

inline Eigen::Matrix2d matrix(const Symmetric2& m) {
  Eigen::Matrix2d result;
  result << m.xx, m.xy, m.xy, m.yy;
  return result;
}

/// Derivative of `function` at `at` by central differences: one column per coordinate.
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

/// Normalised squared error of the free states: chi-square with as many degrees of freedom if the
/// covariance is credible.
inline double normalised_error(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance,
                               int degrees_of_freedom) {
  if (degrees_of_freedom == 3) {
    return error.dot(covariance.llt().solve(error));
  }
  Eigen::Matrix2d block;
  block << covariance(0, 0), covariance(0, 2), covariance(2, 0), covariance(2, 2);
  const Eigen::Vector2d free(error.x(), error.z());
  return free.dot(block.llt().solve(free));
}

/// Standard deviation of the mean of n chi-square variables, each divided by its k degrees of
/// freedom.
inline double anees_deviation(std::size_t n, int degrees_of_freedom) {
  return std::sqrt(2.0 / (static_cast<double>(degrees_of_freedom) * static_cast<double>(n)));
}

/// Relative standard deviation of a root mean square of n normal variables.
inline double rmse_deviation(std::size_t n) { return std::sqrt(0.5 / static_cast<double>(n)); }

/// Standard deviation of a share p of n.
inline double share_deviation(double p, std::size_t n) {
  return std::sqrt(p * (1.0 - p) / static_cast<double>(n));
}

}  // namespace cremed::numeric
