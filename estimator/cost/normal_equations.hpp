// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// J' v with J = d(R m + t) / d(x, y, yaw) = (1, 0, -lever_y; 0, 1, lever_x) and the lever R m.
inline Eigen::Vector3d along_states(const Eigen::Vector2d& v, const Eigen::Vector2d& lever_m) {
  return {v.x(), v.y(), lever_m.x() * v.y() - lever_m.y() * v.x()};
}

/// J' M J
inline Eigen::Matrix3d point_information(const Symmetric2& m, const Eigen::Vector2d& lever_m) {
  const Eigen::Vector2d by_yaw = m * Eigen::Vector2d(-lever_m.y(), lever_m.x());
  const double yaw_yaw = by_yaw.y() * lever_m.x() - by_yaw.x() * lever_m.y();
  Eigen::Matrix3d result;
  result << m.xx, m.xy, by_yaw.x(), m.xy, m.yy, by_yaw.y(), by_yaw.x(), by_yaw.y(), yaw_yaw;
  return result;
}

/// Systematic errors of all targets of a scan, estimated as nuisance parameters: see SharedDoppler.
using SharedErrors = Eigen::Matrix<double, 5, 1>;

/// The unknowns of a search.
struct Unknowns {
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();  ///< (x_m, y_m, yaw_rad)
  SharedErrors shared = SharedErrors::Zero();
};

/// Gauss-Newton normal equations of the motion (three states), with the shared errors eliminated.
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< J'J
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();     ///< J'r
  double cost = 0.0;                                      ///< Negative log likelihood + constant.
  /// The best shared errors for this motion, where the next linearisation takes place.
  SharedErrors shared = SharedErrors::Zero();

  /// Adds J' M J and J' v of a point with the lever R m.
  void add_point(const Symmetric2& m, const Eigen::Vector2d& v, const Eigen::Vector2d& lever_m);
};

/// The result of a search.
struct Estimate {
  Eigen::Vector3d motion;
  Eigen::Matrix3d covariance;
};

/// Smallest reciprocal condition number that counts as positive definite: two of the 16 digits of a
/// double are left.
inline constexpr double kMinReciprocalCondition = 1e-14;

/// Inverse of the information of the free states, (x, yaw) or (x, y, yaw), and zeros elsewhere;
/// none if it is not positive definite.
std::optional<Eigen::Matrix3d> invert_information(const Eigen::Matrix3d& information,
                                                  int degrees_of_freedom);

}  // namespace cremed
