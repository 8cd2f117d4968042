// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace cremed {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Interval that contains the ANEES of `count` consistent estimates with probability `confidence`:
/// n d ANEES is chi-square with n d degrees of freedom. NaN for no estimate.
Interval anees_interval(std::size_t count, int degrees_of_freedom, double confidence);

}  // namespace cremed
