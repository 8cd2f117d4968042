// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>

#include "cremed/estimator/registration/registration_options.hpp"

namespace cremed {

/// The paper's settings for a family of problems: "psr", "sim", "nuscenes" or "robot"; nothing for
/// another name.
std::optional<RegistrationOptions> profile(std::string_view name, bool doppler,
                                           Likelihood likelihood = Likelihood::exclusive);

/// "exclusive" or "max_sum_mixture", as in cremed.toml.
Likelihood likelihood_named(std::string_view name);

}  // namespace cremed
