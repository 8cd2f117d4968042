// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/gaussian_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace cremed {

GaussianState::GaussianState(int size)
    : mean_(Eigen::VectorXd::Zero(size)),
      covariance_(Eigen::MatrixXd::Zero(size, size)),
      gain_(Gain::Zero(size, kNumbers)),
      whitened_residual_(Eigen::Vector3d::Zero()),
      innovations_(Eigen::Vector3d::Zero()) {}

double GaussianState::std(int i) const { return std::sqrt(covariance_(i, i)); }

void GaussianState::set(int i, double value, double variance) {
  mean_(i) = value;
  covariance_.row(i).setZero();
  covariance_.col(i).setZero();
  covariance_(i, i) = variance;
}

void GaussianState::forget(int i, double factor, double noise_variance) {
  mean_(i) *= factor;
  covariance_.row(i) *= factor;
  covariance_.col(i) *= factor;
  covariance_(i, i) += noise_variance;
}

void GaussianState::copy(int from, int to) {
  mean_.segment<3>(to) = mean_.segment<3>(from);
  for (int k = 0; k < 3; ++k) {
    covariance_.col(to + k) = covariance_.col(from + k);
  }
  for (int k = 0; k < 3; ++k) {
    covariance_.row(to + k) = covariance_.row(from + k);
  }
}

void GaussianState::transform_pose(int to, const Eigen::Vector3d& mean,
                                   const Eigen::Matrix3d& by_self,
                                   const Eigen::Matrix3d& by_first) {
  const Eigen::Matrix3d own = covariance_.block<3, 3>(to, to);
  const Eigen::Matrix3d cross = covariance_.block<3, 3>(to, 0);
  const Eigen::Matrix3d first = covariance_.topLeftCorner<3, 3>();
  const Eigen::Matrix3d mixed = by_self * cross * by_first.transpose();
  const Eigen::Matrix3d corner = by_self * own * by_self.transpose() + mixed + mixed.transpose() +
                                 by_first * first * by_first.transpose();
  for (Eigen::Index j = 0; j < covariance_.cols(); ++j) {
    const Eigen::Vector3d column =
        by_self * covariance_.col(j).segment<3>(to) + by_first * covariance_.col(j).head<3>();
    covariance_.col(j).segment<3>(to) = column;
  }
  for (int k = 0; k < 3; ++k) {
    covariance_.col(to + k) = covariance_.row(to + k).transpose();
  }
  covariance_.block<3, 3>(to, to) = 0.5 * (corner + corner.transpose());
  mean_.segment<3>(to) = mean;
}

double GaussianState::innovate(const LinearMeasurement& measurement) {
  gain_.setZero();
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    for (int number = 0; number < kNumbers; ++number) {
      gain_.col(number) += measurement.jacobian[i](number) * covariance_.col(measurement.state[i]);
    }
  }
  Eigen::Matrix3d innovation = measurement.noise;
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    innovation += measurement.jacobian[i] * gain_.row(measurement.state[i]);
  }
  const Eigen::LLT<Eigen::Matrix3d> root(innovation);
  if (root.info() != Eigen::Success) {
    gain_.setZero();
    return std::numeric_limits<double>::infinity();
  }
  innovations_ = measurement.residual.cwiseAbs2().cwiseQuotient(innovation.diagonal());
  root.matrixU().solveInPlace<Eigen::OnTheRight>(gain_);
  whitened_residual_ = root.matrixL().solve(measurement.residual);
  return whitened_residual_.squaredNorm();
}

void GaussianState::update(std::span<const Considered> considered) {
  static_assert(kNumbers == 3);
  // One sum a column: each number by itself would load and store the covariance again.
  for (Eigen::Index j = 0; j < covariance_.cols(); ++j) {
    covariance_.col(j) -=
        gain_(j, 0) * gain_.col(0) + gain_(j, 1) * gain_.col(1) + gain_(j, 2) * gain_.col(2);
  }
  for (const Considered& a : considered) {
    for (const Considered& b : considered) {
      for (int number = std::max(a.from, b.from); number < kNumbers; ++number) {
        covariance_(a.state, b.state) += gain_(a.state, number) * gain_(b.state, number);
      }
    }
  }
  for (const Considered& a : considered) {
    gain_.row(a.state).tail(kNumbers - a.from).setZero();
  }
  for (int number = 0; number < kNumbers; ++number) {
    mean_ += whitened_residual_(number) * gain_.col(number);
  }
}

}  // namespace cremed
