// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/profile.hpp"

namespace cremed {

std::optional<RegistrationOptions> profile(std::string_view name, bool doppler,
                                           Likelihood likelihood) {
  RegistrationOptions options;
  options.doppler.enabled = doppler;
  options.likelihood = likelihood;
  if (name == "nuscenes") {
    options.doppler.stamp_std_s = 0.005;  // The paper's; all else is the default.
    return options;
  }
  // The simulated problems have no shared errors, and Doppler in the current scan only.
  options.shared_errors = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  options.doppler.both_scans = false;
  if (name == "psr") {
    options.degrees_of_freedom = 3;
    options.outlier_ray.weight = 0.0;
    options.start_scale = 1.0;
    return options;
  }
  if (name == "robot") {
    options.outlier_ray.weight = 0.2;
    options.start_scale = 2.0;
    return options;
  }
  if (name == "sim") {
    options.outlier_ray.weight = 0.2;
    options.start_scale = 6.0;
    options.start_doppler_scale = 1.0;
    return options;
  }
  return std::nullopt;
}

Likelihood likelihood_named(std::string_view name) {
  return name == "exclusive" ? Likelihood::exclusive : Likelihood::max_sum_mixture;
}

}  // namespace cremed
