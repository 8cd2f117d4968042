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

  void add(const Eigen::Vector3d& derivative, double value, double variance);
  void add(const MotionSums& other);
  [[nodiscard]] Eigen::Vector3d solution() const;
  [[nodiscard]] double chi_square() const;
};

}  // namespace cremed
