// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/fusion/state/gaussian_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Cholesky>

namespace cremed {

GaussianState::GaussianState(int size, bool has_faults)
    : mean_(Eigen::VectorXd::Zero(size)), covariance_(Eigen::MatrixXd::Zero(size, size)) {
  if (size > Innovation::kMaxStates) {
    throw std::length_error("too many states");
  }
  by_faults_.setZero(size, has_faults ? LinearMeasurement::kFaults : 0);
}

double GaussianState::std(int i) const { return std::sqrt(covariance_(i, i)); }

void GaussianState::set(int i, double value, double variance) {
  mean_(i) = value;
  covariance_.row(i).setZero();
  covariance_.col(i).setZero();
  covariance_(i, i) = variance;
  by_faults_.row(i).setZero();
}

void GaussianState::decay(int i, double factor, double noise_variance) {
  mean_(i) *= factor;
  by_faults_.row(i) *= factor;
  covariance_.row(i) *= factor;
  covariance_.col(i) *= factor;
  covariance_(i, i) += noise_variance;
}

Innovation GaussianState::innovate(const LinearMeasurement& measurement) const {
  Innovation result;
  Innovation::Gain& gain = result.gain;
  gain.setZero(mean_.size(), Innovation::kNumbers);
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    for (int number = 0; number < Innovation::kNumbers; ++number) {
      gain.col(number) += measurement.jacobian[i](number) * covariance_.col(measurement.state[i]);
    }
  }
  Eigen::Matrix3d covariance = measurement.noise;
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    covariance += measurement.jacobian[i] * gain.row(measurement.state[i]);
  }
  const Eigen::LLT<Eigen::Matrix3d> root(covariance);
  if (root.info() != Eigen::Success) {
    gain.setZero();
    result.whitened.setZero();
    result.whitened_by_faults.setZero();
    result.nis = std::numeric_limits<double>::infinity();
    result.nis_of_numbers.setConstant(result.nis);
    return result;
  }
  root.matrixU().solveInPlace<Eigen::OnTheRight>(gain);
  result.whitened = root.matrixL().solve(measurement.residual);
  result.whitened_by_faults = root.matrixL().solve(residual_by_faults(measurement));
  result.nis = result.whitened.squaredNorm();
  result.nis_of_numbers = measurement.residual.cwiseAbs2().cwiseQuotient(covariance.diagonal());
  return result;
}

/// Derivative of the measurement's residual z - h(x) by the faults.
LinearMeasurement::ByFaults GaussianState::residual_by_faults(
    const LinearMeasurement& measurement) const {
  LinearMeasurement::ByFaults by_faults = measurement.by_faults;
  for (Eigen::Index fault = 0; fault < by_faults_.cols(); ++fault) {
    for (int k = 0; k < measurement.states; ++k) {
      const auto i = static_cast<std::size_t>(k);
      by_faults.col(fault) -= measurement.jacobian[i] * by_faults_(measurement.state[i], fault);
    }
  }
  return by_faults;
}

void GaussianState::correct_faults(int first, const Eigen::Vector3d& mean,
                                   const Eigen::Matrix3d& covariance) {
  const auto by_faults = by_faults_.middleCols<3>(first);
  const Eigen::Matrix3d factor = covariance.llt().matrixL();
  const Innovation::Gain root = by_faults.lazyProduct(factor);
  for (Eigen::Index j = 0; j < covariance_.cols(); ++j) {
    covariance_.col(j) +=
        root(j, 0) * root.col(0) + root(j, 1) * root.col(1) + root(j, 2) * root.col(2);
  }
  mean_ -= by_faults * mean;
}

void GaussianState::update(const Innovation& innovation, std::span<const Considered> considered) {
  static_assert(Innovation::kNumbers == 3);
  Innovation::Gain gain = innovation.gain;
  // One sum a column: each number by itself would load and store the covariance again.
  for (Eigen::Index j = 0; j < covariance_.cols(); ++j) {
    covariance_.col(j) -=
        gain(j, 0) * gain.col(0) + gain(j, 1) * gain.col(1) + gain(j, 2) * gain.col(2);
  }
  for (const Considered& a : considered) {
    for (const Considered& b : considered) {
      for (int number = std::max(a.from, b.from); number < Innovation::kNumbers; ++number) {
        covariance_(a.state, b.state) += gain(a.state, number) * gain(b.state, number);
      }
    }
  }
  for (const Considered& a : considered) {
    gain.row(a.state).tail(Innovation::kNumbers - a.from).setZero();
  }
  for (int number = 0; number < Innovation::kNumbers; ++number) {
    mean_ += innovation.whitened(number) * gain.col(number);
    for (Eigen::Index fault = 0; fault < by_faults_.cols(); ++fault) {
      by_faults_.col(fault) += innovation.whitened_by_faults(number, fault) * gain.col(number);
    }
  }
}

}  // namespace cremed
