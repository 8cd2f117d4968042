// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "cremed/estimator/scan/symmetric2.hpp"

namespace cremed {

/// Rotation of the plane, counter-clockwise.
class Rotation {
 public:
  explicit Rotation(double angle_rad) : cos_(std::cos(angle_rad)), sin_(std::sin(angle_rad)) {}

  /// R p
  [[nodiscard]] Eigen::Vector2d operator*(const Eigen::Vector2d& p) const {
    return {cos_ * p.x() - sin_ * p.y(), sin_ * p.x() + cos_ * p.y()};
  }
  /// R S R'
  [[nodiscard]] Symmetric2 operator*(const Symmetric2& s) const {
    const double cc = cos_ * cos_;
    const double cs = cos_ * sin_;
    const double ss = sin_ * sin_;
    return {cc * s.xx - 2.0 * cs * s.xy + ss * s.yy, cs * (s.xx - s.yy) + (cc - ss) * s.xy,
            ss * s.xx + 2.0 * cs * s.xy + cc * s.yy};
  }

 private:
  double cos_;
  double sin_;
};

}  // namespace cremed
