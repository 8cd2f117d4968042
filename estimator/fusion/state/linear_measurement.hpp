// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

namespace cremed {

/// A linearised measurement of two numbers: residual z - h(x), and dh/dx for the states it depends
/// on.
struct LinearMeasurement {
  static constexpr int kMaxStates = 80;
  using Column = Eigen::Vector2d;

  Eigen::Vector2d residual = Eigen::Vector2d::Zero();
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();  ///< Covariance of z.
  int states = 0;
  std::array<int, kMaxStates> state{};        ///< Which state,
  std::array<Column, kMaxStates> jacobian{};  ///< and its column of dh/dx.

  void depend_on(int which, const Column& column) {
    state[static_cast<std::size_t>(states)] = which;
    jacobian[static_cast<std::size_t>(states)] = column;
    ++states;
  }
};

}  // namespace cremed
