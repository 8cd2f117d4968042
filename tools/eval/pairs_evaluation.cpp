// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/pairs_evaluation.hpp"

#include <limits>

#include "daemon/replay.hpp"

namespace cremed {
namespace {

bool has_solution(const RegistrationResult& result) {
  return result.status == RegistrationStatus::converged ||
         result.status == RegistrationStatus::no_convergence;
}

}  // namespace

TargetSet to_targets(const std::vector<Detection>& detections, const Pose2& vehicle_from_radar) {
  TargetSet targets;
  for (const Detection& detection : detections) {
    targets.add(detection, vehicle_from_radar);
  }
  return targets;
}

std::vector<PairResult> solve_pairs(const std::vector<RegistrationPair>& pairs,
                                    const RegistrationOptions& options) {
  std::vector<PairResult> results;
  for (const RegistrationPair& pair : pairs) {
    const TargetSet previous = to_targets(pair.previous, pair.vehicle_from_radar);
    const TargetSet current = to_targets(pair.current, pair.vehicle_from_radar);
    PairResult result;
    if (previous.size() > 0 && current.size() > 0) {
      Registration registration(options, pair.vehicle_from_radar);
      const std::int64_t begin_us = monotonic_us();
      registration.set_previous(previous);
      result.registration = registration.solve(current, pair.dt_s);
      result.solve_us = monotonic_us() - begin_us;
    }
    if (!has_solution(result.registration)) {
      result.registration.motion.setConstant(std::numeric_limits<double>::quiet_NaN());
      result.registration.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    results.push_back(result);
  }
  return results;
}

Credibility evaluate_pairs(const std::vector<RegistrationPair>& pairs,
                           const std::vector<PairResult>& results, int degrees_of_freedom,
                           std::size_t& left_out) {
  Credibility credibility(degrees_of_freedom);
  left_out = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const RegistrationResult& result = results[i].registration;
    if (has_solution(result)) {
      const Pose2& truth = pairs[i].truth;
      credibility.add(result.motion, result.covariance, {truth.x_m, truth.y_m, truth.yaw_rad});
    } else {
      ++left_out;
    }
  }
  return credibility;
}

}  // namespace cremed
