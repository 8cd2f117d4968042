// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/registration/registration.hpp"
#include "tools/laboratory/pairs/registration_pairs.hpp"

namespace cremed {

/// A bound for any registration: least squares with known correspondences (equal ids), with
/// covariance C_ij = S_j + R S_i R' of each difference and, if enabled in `options`, the Doppler of
/// all targets of the current scan without a component for moving ones. Gauss-Newton from zero;
/// degrees of freedom and Doppler noise are those of `options`.
RegistrationResult register_known(const RegistrationPair& pair, const RegistrationOptions& options);

}  // namespace cremed
