// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/registration/registration_result.hpp"
#include "cremed/estimator/scan/gate.hpp"

namespace cremed {

/// The previous motion continued over the time between two scans, and the largest departure from it
/// that a vehicle can reach by accelerating.
struct ContinuedMotion {
  Eigen::Vector3d motion;
  Eigen::Vector3d max_departure;

  /// Whether a result is possible after the previous motion. A match of chance neighbours can be
  /// anywhere in the search range, so that it rarely is; a true match departs by its noise only.
  [[nodiscard]] bool allows(const RegistrationResult& result) const {
    const Eigen::Vector3d sigma = result.covariance.diagonal().cwiseSqrt();
    const Eigen::Vector3d departure = (result.motion - motion).cwiseAbs();
    return sigma.x() > 0.0 &&
           (departure.array() <= (max_departure + kGateSigmas * sigma).array()).all();
  }
};

/// A motion that is known well enough to be refined without a search.
struct PredictedMotion {
  Eigen::Vector3d motion;
  ContinuedMotion continued;
};

}  // namespace cremed
