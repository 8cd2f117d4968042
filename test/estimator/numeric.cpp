// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/numeric.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace cremed::numeric {

double radians(double degrees) { return degrees * 3.1415926535897932 / 180.0; }

Eigen::Matrix2d matrix(const Symmetric2& m) {
  Eigen::Matrix2d result;
  result << m.xx, m.xy, m.xy, m.yy;
  return result;
}

double normalised_error(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance,
                        int degrees_of_freedom) {
  if (degrees_of_freedom == 3) {
    return error.dot(covariance.llt().solve(error));
  }
  Eigen::Matrix2d block;
  block << covariance(0, 0), covariance(0, 2), covariance(2, 0), covariance(2, 2);
  const Eigen::Vector2d free(error.x(), error.z());
  return free.dot(block.llt().solve(free));
}

Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(symmetric, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

Eigen::VectorXd coloured(const Eigen::VectorXd& white, const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().cwiseProduct(white);
}

double anees_deviation(std::size_t n, int degrees_of_freedom) {
  return std::sqrt(2.0 / (static_cast<double>(degrees_of_freedom) * static_cast<double>(n)));
}

double rmse_deviation(std::size_t n) { return std::sqrt(0.5 / static_cast<double>(n)); }

double share_deviation(double p, std::size_t n) {
  return std::sqrt(p * (1.0 - p) / static_cast<double>(n));
}

}  // namespace cremed::numeric
