// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// The predicted change u of a static target's range over an ego-motion (x, y, yaw), seen from a
/// radar at (x_S, y_S), and its derivatives; (2) of the README:
///     u = -(x - yaw y_S) cos phi - (y + yaw x_S) sin phi
struct DopplerGeometry {
  DopplerGeometry(const Target& target, const Eigen::Vector3d& motion,
                  const Pose2& vehicle_from_radar);

  double range_change_m;        ///< u
  double per_bearing_m;         ///< du/dphi
  Eigen::RowVector3d jacobian;  ///< du/d(x, y, yaw)
};

/// Doppler residual of one target.
struct DopplerResidual {
  double error_m = 0.0;   ///< Predicted minus measured change of range.
  double per_m = 0.0;     ///< One over the chosen component's standard deviation.
  double cost = 0.0;      ///< -log of the chosen component, up to a constant.
  bool is_static = true;  ///< false: the moving component is more likely.
};

/// Two-component max mixture of a static and a moving target (RA-L 2022, Doppler factor). Its
/// variance dt^2 s_v^2 + v^2 s_dt^2 + (du/dphi)^2 s_azimuth^2 is held fixed in derivatives. `scale`
/// multiplies the static component's measured standard deviation (first stage; else 1). `shared_m`:
/// the systematic error, added to the predicted change of range.
DopplerResidual doppler_residual(const Target& target, const DopplerGeometry& geometry, double dt_s,
                                 const DopplerOptions& options, double scale,
                                 double shared_m = 0.0);

}  // namespace cremed
