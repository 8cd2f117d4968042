// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace cremed {

/// A linearised measurement of up to three numbers: residual z - h(x), and dh/dx for the states it
/// depends on. A number that is not measured has no residual, a noise of 1 and depends on nothing.
struct LinearMeasurement {
  static constexpr int kMaxStates = 80;
  static constexpr int kFaults = 6;
  using Column = Eigen::Vector3d;
  using ByFaults = Eigen::Matrix<double, 3, kFaults>;

  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  Eigen::Matrix3d noise = Eigen::Matrix3d::Identity();  ///< Covariance of z.
  /// Derivative of z by the faults of GaussianState.
  ByFaults by_faults = ByFaults::Zero();
  int states = 0;
  std::array<int, kMaxStates> state{};        ///< Indices of the states.
  std::array<Column, kMaxStates> jacobian{};  ///< Column of dh/dx by each.

  /// `column`: of the first numbers, as many as it has.
  template <typename Derived>
  void depend_on(int which, const Eigen::MatrixBase<Derived>& column) {
    const auto i = static_cast<std::size_t>(states++);
    state[i] = which;
    jacobian[i].setZero();
    jacobian[i].template head<Derived::RowsAtCompileTime>() = column;
  }
  void depend_on(int which, double first, double second = 0.0) {
    depend_on(which, Eigen::Vector2d(first, second));
  }
};

}  // namespace cremed
