// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cremed/estimator/cost/mixture_kernel.hpp"

namespace cremed {

/// Lower bound on the cost of a mixture that evaluates every component: difference, Mahalanobis
/// distance in two dimensions, exponential, sum, vectorised for the instruction set of the
/// mixture's kernel. Returns the sum.
double evaluate_floor(const MixtureComponents& components, const MixturePoint& point);

/// Nanoseconds per evaluation of a component at that bound, for this many components.
double floor_ns(std::size_t components);

}  // namespace cremed
