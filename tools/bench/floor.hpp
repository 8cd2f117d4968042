// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/cost/mixture_kernel.hpp"

namespace cremed {

/// The least that a mixture costs if every component is evaluated: difference, Mahalanobis distance
/// in two dimensions, exponential, sum. Vectorised for the same instruction set as the mixture's
/// kernel, nothing left out, nothing else done. Returns the sum.
double evaluate_floor(const MixtureComponents& components, const MixturePoint& point);

/// Nanoseconds an evaluation of a component takes that way, with so many components.
double floor_ns(std::size_t components);

}  // namespace cremed
