// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace cremed {

/// Costs of a small registration along a line, each relative to its minimum.
struct CostPoint {
  double translation_m = 0.0;
  double likelihood = 0.0;         ///< Exact negative log likelihood, summed directly.
  double sum_approximation = 0.0;  ///< See sum_approximation_cost().
  double msm = 0.0;                ///< Max-Sum-Mixture without outlier model.
  double msm_with_ray = 0.0;       ///< Max-Sum-Mixture with outlier ray.
};

/// Figure 1 of the paper: a few targets on the radar's axis that moved by kCurveTruthM; with
/// `outlier`, one more in the current scan without a partner.
std::vector<CostPoint> cost_curves(bool outlier);
inline constexpr double kCurveTruthM = 0.5;

/// Both as CSV: `outlier,truth_m,translation_m,likelihood,sum_approximation,msm,msm_with_ray`.
/// Throws std::runtime_error.
void write_cost_csv(const std::string& path);

}  // namespace cremed
