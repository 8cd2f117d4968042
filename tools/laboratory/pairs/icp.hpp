// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tools/laboratory/pairs/registration_method.hpp"

namespace cremed {

/// Point-to-point ICP in the plane (Besl and McKay 1992), started at zero: every target of the
/// current scan with the nearest of the previous one, equally weighted. Covariance:
/// icp_covariance().
RegistrationResult register_icp(const TargetSet& previous, const TargetSet& current,
                                const RegistrationContext& context);

}  // namespace cremed
