// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/registration/registration.hpp"
#include "tools/eval/pairs/registration_pairs.hpp"

namespace cremed {

/// The bound of any registration: the least squares that knows which targets correspond (equal
/// ids), with covariance C_ij = S_j + R S_i R' of each difference and, if `options` say so, the
/// Doppler of all targets of the current scan without the component for moving ones. Gauss-Newton
/// from zero; degrees of freedom and Doppler's standard deviations are those of `options`.
RegistrationResult register_known(const RegistrationPair& pair, const RegistrationOptions& options);

}  // namespace cremed
