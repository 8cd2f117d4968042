// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace cremed {

/// An error and what was said of it beforehand.
struct ScaledError {
  std::int64_t stamp_us = 0;
  double error = 0.0;           ///< In reported standard deviations.
  double other_variance = 0.0;  ///< Of a part that the report does not speak of, in the same unit.
};

/// How many reported standard deviations make a true one.
struct StdFactor {
  double value = 1.0;
  double std = 0.0;  ///< 0: not known.
};

/// Greatest error, in reported standard deviations, that noise_factor() takes.
inline constexpr double kErrorGate = 5.0;

/// Errors are Gaussian with `factor` for standard deviation, or nonsense (evenly spread up to the
/// gate): the most likely factor and share of nonsense. Its standard deviation comes from how
/// blocks of 2 s disagree. `assumed` is a factor that the errors' standard deviations already have;
/// the result includes it.
StdFactor noise_factor(const std::vector<ScaledError>& errors, double assumed = 1.0);

}  // namespace cremed
