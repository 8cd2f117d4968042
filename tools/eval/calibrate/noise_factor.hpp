// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace cremed {

/// An error and its predicted variance.
struct ScaledError {
  std::int64_t stamp_us = 0;
  double error = 0.0;           ///< In reported standard deviations.
  double other_variance = 0.0;  ///< Variance of a part not in the report, in the same unit.
};

/// Ratio of true to reported standard deviation.
struct StdFactor {
  double value = 1.0;
  double std = 0.0;  ///< 0: unknown.
};

/// Largest error, in reported standard deviations, that noise_factor() uses.
inline constexpr double kErrorGate = 5.0;

/// Maximum likelihood of a mixture: Gaussian errors with standard deviation `factor`, and outliers
/// uniform up to the gate. The result's standard deviation comes from the scatter between blocks of
/// 2 s. `assumed` is a factor that the errors' standard deviations already contain; the result
/// includes it.
StdFactor noise_factor(const std::vector<ScaledError>& errors, double assumed = 1.0);

}  // namespace cremed
