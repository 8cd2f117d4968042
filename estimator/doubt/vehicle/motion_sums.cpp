// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/motion_sums.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace cremed {

void MotionSums::add(const Eigen::Vector3d& derivative, double value, double variance) {
  information += derivative * derivative.transpose() / variance;
  weighted += derivative * (value / variance);
  squares += value * value / variance;
}

void MotionSums::add(const MotionSums& other) {
  information += other.information;
  weighted += other.weighted;
  squares += other.squares;
}

Eigen::Vector3d MotionSums::solution() const { return information.ldlt().solve(weighted); }

double MotionSums::chi_square() const { return std::max(0.0, squares - weighted.dot(solution())); }

}  // namespace cremed
