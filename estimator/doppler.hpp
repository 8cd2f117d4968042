// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/pose2.hpp"
#include "estimator/registration_options.hpp"
#include "estimator/target_set.hpp"

namespace cremed {

/// Doppler residual of one target with its Jacobian with respect to the ego-motion (x, y, yaw).
struct DopplerResidual {
  double residual = 0.0;  ///< Whitened by the chosen component.
  Eigen::RowVector3d jacobian = Eigen::RowVector3d::Zero();
  double cost = 0.0;      ///< -log of the chosen component, up to a constant.
  bool is_static = true;  ///< false: explained best as a moving target.
};

/// Two-component max mixture of a static and a moving target (RA-L 2022, Doppler factor). The
/// predicted change of range over dt of a static target seen from a radar at (x_S, y_S) is
///     u = -(x - yaw y_S) cos phi - (y + yaw x_S) sin phi
/// and its variance dt^2 s_v^2 + v^2 s_dt^2 + (du/dphi)^2 s_azimuth^2, held fixed in the Jacobian.
/// `scale` multiplies the static component's measured standard deviation (first stage; else 1).
DopplerResidual doppler_residual(const Target& target, const Eigen::Vector3d& motion,
                                 const Pose2& vehicle_from_radar, double dt_s,
                                 const DopplerOptions& options, double scale);

}  // namespace cremed
