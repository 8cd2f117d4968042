// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "tools/laboratory/pairs/registration_method.hpp"

namespace cremed {

/// The summing approximation that the paper compares with: the likelihoods of the targets are
/// summed instead of multiplied, cost = -log sum_i d_i sum_j q_ij, with q_ij the normal densities
/// of Registration's mixture (equal weights, C_ij = S_j + R S_i R', no outlier ray: the sum is
/// robust by itself) and d_i the density of the target's Doppler (1 without Doppler).
double sum_approximation_cost(const TargetSet& previous, const TargetSet& current,
                              const RegistrationContext& context, const Eigen::Vector3d& motion);

/// Minimises the cost from zero by BFGS, in the two stages of Registration; the covariance is the
/// inverse Hessian (central differences of the automatic gradient), degenerate if it is not
/// positive definite.
RegistrationResult register_sum_approximation(const TargetSet& previous, const TargetSet& current,
                                              const RegistrationContext& context);

}  // namespace cremed
