// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"

namespace cremed {

/// Adds to the covariance of a motion over `dt_s` the systematic errors that no measurement of the
/// two scans shows: of the radar's own velocity over the vehicle's; and, where the motion rests on
/// Doppler, of its scale, and of jerk.
void add_unseen_errors(const SharedErrorOptions& errors, const Eigen::Vector3d& motion, double dt_s,
                       bool by_doppler, int degrees_of_freedom, Eigen::Matrix3d& covariance);

}  // namespace cremed
