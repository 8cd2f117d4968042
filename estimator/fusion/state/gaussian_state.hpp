// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <Eigen/Core>

#include "cremed/estimator/fusion/state/linear_measurement.hpp"

namespace cremed {

/// Difference of a measurement to what a state expects, with the gain by which it updates that
/// state.
struct Innovation {
  static constexpr int kNumbers = 3;      ///< Of a LinearMeasurement.
  static constexpr int kMaxStates = 218;  ///< Those of 16 radars and the vehicle's signals.
  using Gain = Eigen::Matrix<double, Eigen::Dynamic, kNumbers, Eigen::ColMajor, kMaxStates>;

  /// Normalised innovation squared (NIS): chi-square with a degree of freedom for each number of
  /// the measurement if mean and covariance are true. Infinite, without gain, if the innovation's
  /// covariance is not positive definite.
  double nis;
  Eigen::Vector3d nis_of_numbers;  ///< Of each number alone.
  Eigen::Vector3d whitened;        ///< L^-1 residual, with the innovation's covariance S = L L'.
  Gain gain;                       ///< P H' L'^-1: the update adds gain whitened.
  /// Derivative of `whitened` by the faults; zero if there are none.
  LinearMeasurement::ByFaults whitened_by_faults;
};

/// Mean and covariance of a state of fixed size, with the operations of a Kalman filter. Every
/// operation keeps the covariance exactly symmetric and costs O(n), an update O(n^2). Only the
/// constructor allocates.
///
/// Optionally with the derivative of the mean by faults, which are no states: constant errors of
/// some measurements since forget_faults(). By it the innovations tell whether there is such a
/// fault (generalised likelihood ratio; Willsky and Jones, IEEE Trans. Automatic Control 1976).
class GaussianState {
 public:
  /// At most Innovation::kMaxStates, otherwise std::length_error.
  explicit GaussianState(int size, bool has_faults = false);

  [[nodiscard]] int size() const { return static_cast<int>(mean_.size()); }
  [[nodiscard]] const Eigen::VectorXd& mean() const { return mean_; }
  [[nodiscard]] double mean(int i) const { return mean_(i); }
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }
  [[nodiscard]] double variance(int i) const { return covariance_(i, i); }
  [[nodiscard]] double std(int i) const;

  void set_mean(int i, double value) { mean_(i) = value; }
  /// Sets the mean conditional on x_i = `value`; covariances stay. Used for a nearly unknown x_i,
  /// to linearise the next measurement near its true value.
  void assume(int i, double value) {
    mean_ += (value - mean_(i)) / covariance_(i, i) * covariance_.col(i);
    for (Eigen::Index k = 0; k < by_faults_.cols(); ++k) {
      by_faults_.col(k) -= by_faults_(i, k) / covariance_(i, i) * covariance_.col(i);
    }
  }
  /// Sets mean and variance of x_i, independent of all other states.
  void set(int i, double value, double variance);
  void add_variance(int i, double variance) { covariance_(i, i) += variance; }
  void add_covariance(int i, int j, double covariance) { covariance_(i, j) += covariance; }
  /// x_i becomes factor x_i + noise.
  void decay(int i, double factor, double noise_variance);

  /// Replaces the states `to` by a function of the states `of` with value `mean` and derivative
  /// `by`, plus noise. `to`, `of`: indices as Eigen takes them.
  template <typename To, typename Of, int Rows, int Columns>
  void set_to(
      const To& to, const Eigen::Vector<double, Rows>& mean, const Of& of,
      const Eigen::Matrix<double, Rows, Columns>& by,
      const Eigen::Matrix<double, Rows, Rows>& noise = Eigen::Matrix<double, Rows, Rows>::Zero());

  /// Derivative of the mean by the faults; no columns if there are none.
  using ByFaults = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                 Innovation::kMaxStates, LinearMeasurement::kFaults>;
  [[nodiscard]] const ByFaults& by_faults() const { return by_faults_; }
  /// Three faults from `first` on have this mean and covariance: corrects the state by them.
  void correct_faults(int first, const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance);
  /// Takes the mean as free of three faults from `first` on until now.
  void forget_faults(int first) { by_faults_.middleCols<3>(first).setZero(); }

  [[nodiscard]] Innovation innovate(const LinearMeasurement& measurement) const;
  /// A consider parameter (Schmidt-Kalman): components of a measurement from `from` on count its
  /// uncertainty, but do not update it; earlier ones do.
  struct Considered {
    int state;
    int from = 0;
  };
  /// Kalman update with an innovation of this very state.
  void update(const Innovation& innovation, std::span<const Considered> considered);

 private:
  [[nodiscard]] LinearMeasurement::ByFaults residual_by_faults(
      const LinearMeasurement& measurement) const;

  Eigen::VectorXd mean_;
  Eigen::MatrixXd covariance_;
  ByFaults by_faults_;
};

template <typename To, typename Of, int Rows, int Columns>
void GaussianState::set_to(const To& to, const Eigen::Vector<double, Rows>& mean, const Of& of,
                           const Eigen::Matrix<double, Rows, Columns>& by,
                           const Eigen::Matrix<double, Rows, Rows>& noise) {
  // Of the new states with each other: computed before any is replaced, and set after all.
  const Eigen::Matrix<double, Rows, Rows> corner =
      by * covariance_(of, of) * by.transpose() + noise;
  for (Eigen::Index j = 0; j < covariance_.cols(); ++j) {
    covariance_(to, j) = (by * covariance_(of, j)).eval();
  }
  for (int k = 0; k < Rows; ++k) {
    covariance_.col(to[k]) = covariance_.row(to[k]).transpose();
  }
  covariance_(to, to) = 0.5 * (corner + corner.transpose());
  for (Eigen::Index k = 0; k < by_faults_.cols(); ++k) {
    by_faults_(to, k) = (by * by_faults_(of, k)).eval();
  }
  mean_(to) = mean;
}

}  // namespace cremed
