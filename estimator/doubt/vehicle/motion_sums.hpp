// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace cremed {

/// Least squares for the vehicle's motion x = (v, w, slip): information H, H x, and x' H x of the
/// measurements.
struct MotionSums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  double squares = 0.0;

  void add(const Eigen::Vector3d& derivative, double value, double variance) {
    information += derivative * derivative.transpose() / variance;
    weighted += derivative * (value / variance);
    squares += value * value / variance;
  }
  void add(const MotionSums& other) {
    information += other.information;
    weighted += other.weighted;
    squares += other.squares;
  }
  [[nodiscard]] Eigen::Vector3d solution() const { return information.ldlt().solve(weighted); }
  [[nodiscard]] double chi_square() const {
    return std::max(0.0, squares - weighted.dot(solution()));
  }
};

}  // namespace cremed
