// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "cremed/estimator/registration/registration.hpp"

namespace cremed {

/// Input of a registration besides the targets of the two scans.
struct RegistrationContext {
  RegistrationOptions options;
  Pose2 vehicle_from_radar;
  double dt_s = 0.0;
};

using RegisterFunction = RegistrationResult (*)(const TargetSet& previous, const TargetSet& current,
                                                const RegistrationContext& context);

/// A way to register two scans, for comparison.
struct RegistrationMethod {
  RegisterFunction solve = nullptr;
  bool is_always_3dof = false;  ///< Estimates y even if the options have 2 DoF.
};

/// "msm", "sa" or "icp". Throws std::runtime_error for another name.
RegistrationMethod registration_method(std::string_view name);

/// The product's registration: class Registration.
RegistrationResult register_msm(const TargetSet& previous, const TargetSet& current,
                                const RegistrationContext& context);

}  // namespace cremed
