// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// The predicted change u of a static target's range over an ego-motion (x, y, yaw), seen from a
/// radar at (x_S, y_S); (2) of the README:
///     u = -(x - yaw y_S) cos phi - (y + yaw x_S) sin phi
/// It is linear in z = (1, cos phi, sin phi): u = z' (du/dz). These are the derivatives of du/dz by
/// x, y and yaw, one a row.
Eigen::Matrix3d doppler_by_motion(const Pose2& vehicle_from_radar);

/// du/dphi, as factors of z like `change`.
inline Eigen::Vector3d doppler_by_bearing(const Eigen::Vector3d& change) {
  return {0.0, change.z(), -change.y()};
}

/// Doppler residual of one target.
struct DopplerResidual {
  double error_m = 0.0;  ///< Predicted minus measured change of range.
  // Of the chosen component:
  double variance_m2 = 0.0;
  double weight = 0.0;
  bool is_static = true;  ///< false: the moving component is more likely.

  /// -log of the chosen component, up to a constant.
  [[nodiscard]] double cost() const;
};

/// Two-component max mixture of a static and a moving target (RA-L 2022, Doppler factor). Its
/// variance dt^2 s_v^2 + v^2 s_dt^2 + (du/dphi)^2 s_azimuth^2 is held fixed in derivatives. `scale`
/// multiplies the static component's measured standard deviation (first stage; else 1).
/// `predicted_m`: u, and the systematic error.
DopplerResidual doppler_residual(const Target& target, double predicted_m, double per_bearing_m,
                                 double dt_s, const DopplerOptions& options, double scale);

/// Sums over the targets of a scan, weighted by the inverse of the variance. Whatever is linear in
/// z has its normal equations from them.
struct DopplerSums {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();  ///< z z'
  Eigen::Vector3d errors = Eigen::Vector3d::Zero();    ///< z e
  double cost = 0.0;
};

/// `change`: u, `systematic`: the error of all targets that is added to it, as factors of z.
DopplerSums sum_doppler(const TargetSet& targets, const Eigen::Vector3d& change,
                        const Eigen::Vector3d& systematic, double dt_s,
                        const DopplerOptions& options, double scale);

}  // namespace cremed
