// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

/// Least squares for the vehicle's motion x = (v, w, slip): information H, H x, and x' H x of the
/// measurements.
struct MotionSums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  double squares = 0.0;
  /// Covariance of H x by the random part of the errors; the rest stays the same for seconds.
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& derivative, double value, double variance,
           double random_variance = 0.0);
  void add(const MotionSums& other);
  [[nodiscard]] Eigen::Vector3d solution() const;
  [[nodiscard]] double chi_square() const;
  /// Of the solution, by the random part of the errors.
  [[nodiscard]] Eigen::Matrix3d random_covariance() const;
};

}  // namespace cremed
