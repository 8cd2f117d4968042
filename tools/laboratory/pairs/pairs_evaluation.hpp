// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "cremed/estimator/registration/registration.hpp"
#include "tools/eval/credibility.hpp"
#include "tools/laboratory/pairs/registration_method.hpp"
#include "tools/laboratory/pairs/registration_pairs.hpp"

namespace cremed {

/// One pair's solution.
struct PairResult {
  RegistrationResult registration;
  std::int64_t solve_us = 0;  ///< Processor time, independent of other programs.
};

/// Whether there is a motion with a covariance, converged or not.
bool has_solution(const RegistrationResult& result);

/// Solves a pair; motion and covariance are NaN without a solution.
PairResult solve_pair(const RegistrationPair& pair, const RegistrationOptions& options,
                      RegisterFunction method = register_msm);

/// Solves every pair on its own.
std::vector<PairResult> solve_pairs(const std::vector<RegistrationPair>& pairs,
                                    const RegistrationOptions& options,
                                    RegisterFunction method = register_msm);

/// Compares the solutions with truth. Pairs without a covariance (degenerate, not finite) are
/// omitted and counted in `left_out`.
Credibility evaluate_pairs(const std::vector<RegistrationPair>& pairs,
                           const std::vector<PairResult>& results, int degrees_of_freedom,
                           std::size_t& left_out);

/// The targets of a scan in the vehicle frame.
TargetSet to_targets(const std::vector<Detection>& detections, const Pose2& vehicle_from_radar);

}  // namespace cremed
