// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"
#include "tools/laboratory/pairs/registration_method.hpp"

namespace cremed {

/// Covariance of a point-to-point ICP's solution (Censi 2007, Prakhya et al. 2015): with
/// J = 1/2 sum |R p_i + t - q_i|^2 over each target p_i of the current scan and the nearest q_i of
/// the previous one,
///     cov = H^-1 (d2J/dzdx) cov(z) (d2J/dzdx)' H^-1, H = d2J/dx2, z = all p_i and q_i,
/// with all correspondences independent. Nothing if H is not positive definite.
std::optional<Eigen::Matrix3d> icp_covariance(const TargetSet& previous, const TargetSet& current,
                                              const Eigen::Vector3d& motion);

/// Point-to-point ICP in the plane (Besl and McKay 1992), started at zero: every target of the
/// current scan with the nearest of the previous one, equally weighted. Covariance:
/// icp_covariance().
RegistrationResult register_icp(const TargetSet& previous, const TargetSet& current,
                                const RegistrationContext& context);

}  // namespace cremed
