// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace cremed {

/// Lower bound on the cost of a mixture that evaluates every component: difference, Mahalanobis
/// distance in two dimensions with a known covariance, exponential, sum. Nanoseconds per evaluation
/// of a component, for this many components.
double floor_ns(std::size_t components);

}  // namespace cremed
