// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "cremed/estimator/cost/cost_options.hpp"

namespace cremed {

/// The likelihood that is maximised and that gives the covariance.
enum class Likelihood : std::uint8_t {
  exclusive,        ///< All one-to-one assignments of targets: see ExclusiveCost.
  max_sum_mixture,  ///< The paper's: see MixtureCost. Over-confident where targets cluster.
};

/// Settings of one registration. Source: shared settings table of the paper (RA-L 2022).
struct RegistrationOptions {
  int degrees_of_freedom = 2;  ///< 2: x and yaw (car-like, y = 0). 3: x, y, yaw.
  double start_scale = 5.0;    ///< Factor on standard deviations in the first stage; 1: no stage.
  /// Further factor on standard deviations of Doppler in the first stage. In the paper 2 for
  /// sensors, 1 in simulation.
  double start_doppler_scale = 2.0;
  int max_iterations = 100;  ///< Gauss-Newton steps of the second stage.
  /// Limit on the work of one registration, in evaluations of a mixture component.
  std::int64_t max_component_evaluations = 800'000;
  Likelihood likelihood = Likelihood::exclusive;
  OutlierRayOptions outlier_ray;
  DopplerOptions doppler;
  SharedErrorOptions shared_errors;

  bool operator==(const RegistrationOptions&) const = default;
};

}  // namespace cremed
