// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"

namespace cremed {

/// Adds the part of the consider parameters to the covariance of a motion over `dt_s`. These are
/// systematic errors that two scans cannot observe: the velocity of the body over the wheels and,
/// if Doppler was used, its scale, its rounding and jerk.
void add_consider_covariance(const SharedErrorOptions& errors, const Eigen::Vector3d& motion,
                             double dt_s, bool by_doppler, int degrees_of_freedom,
                             Eigen::Matrix3d& covariance);

}  // namespace cremed
