// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/doubt/vehicle/motion_sums.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "cremed/estimator/scan/squared.hpp"

namespace cremed {

void MotionSums::add(const Eigen::Vector3d& derivative, double value, double variance,
                     double random_variance) {
  information += derivative * derivative.transpose() / variance;
  weighted += derivative * (value / variance);
  squares += value * value / variance;
  scatter += derivative * derivative.transpose() * (random_variance / squared(variance));
}

void MotionSums::add_velocity(const Pose2& mount, const Eigen::Vector2d& mps,
                              const Eigen::Matrix2d& covariance, const Eigen::Matrix2d& random) {
  Eigen::Matrix<double, 2, 3> by;
  by << 1.0, -mount.y_m, 0.0, 0.0, mount.x_m, mps.x();
  const Eigen::Matrix2d weight = covariance.inverse();
  information += by.transpose() * weight * by;
  weighted += by.transpose() * weight * mps;
  squares += mps.dot(weight * mps);
  scatter += by.transpose() * weight * random * weight * by;
}

void MotionSums::add(const MotionSums& other) {
  information += other.information;
  weighted += other.weighted;
  squares += other.squares;
  scatter += other.scatter;
}

Eigen::Vector3d MotionSums::solution() const { return information.ldlt().solve(weighted); }

double MotionSums::chi_square() const { return std::max(0.0, squares - weighted.dot(solution())); }

Eigen::Matrix3d MotionSums::covariance() const { return information.inverse(); }

Eigen::Matrix3d MotionSums::random_covariance() const {
  const Eigen::Matrix3d of_all = covariance();
  return of_all * scatter * of_all;
}

}  // namespace cremed
