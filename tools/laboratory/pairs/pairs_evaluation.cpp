// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/pairs_evaluation.hpp"

#include <cmath>
#include <ctime>
#include <limits>

namespace cremed {
namespace {

/// Sums of what becomes means.
void add_result(const PairResult& result, int degrees_of_freedom, PairsFigures& figures) {
  const RegistrationResult& r = result.registration;
  figures.iterations += r.iterations;
  figures.solve_us += static_cast<double>(result.solve_us);
  figures.no_convergence += r.status == RegistrationStatus::no_convergence ? 1U : 0U;
  if (!has_solution(r)) {
    ++figures.left_out;
    figures.ambiguous += r.status == RegistrationStatus::ambiguous ? 1U : 0U;
    return;
  }
  const double nees =
      normalised_error_squared(r.motion, r.covariance, result.truth, degrees_of_freedom);
  figures.credibility.add(r.motion, r.covariance, result.truth);
  figures.nees.add(nees);
  figures.gross += nees > kGrossNees ? 1U : 0U;
}

}  // namespace

double processor_us() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

bool has_solution(const RegistrationResult& result) {
  return result.has_motion() && result.covariance(0, 0) > 0.0;
}

TargetSet to_targets(const std::vector<Detection>& detections, const Pose2& vehicle_from_radar) {
  TargetSet targets;
  for (const Detection& detection : detections) {
    targets.add(detection, vehicle_from_radar);
  }
  return targets;
}

PairResult solve_pair(const RegistrationPair& pair, const RegistrationOptions& options,
                      RegisterFunction method) {
  const TargetSet previous = to_targets(pair.previous, pair.vehicle_from_radar);
  const TargetSet current = to_targets(pair.current, pair.vehicle_from_radar);
  PairResult result{.truth = {pair.truth.x_m, pair.truth.y_m, pair.truth.yaw_rad}};
  if (previous.size() > 0 && current.size() > 0) {
    const RegistrationContext context{options, pair.vehicle_from_radar, pair.dt_s};
    const double begin_us = processor_us();
    result.registration = method(previous, current, context);
    result.solve_us = std::llround(processor_us() - begin_us);
  }
  if (!has_solution(result.registration)) {
    result.registration.motion.setConstant(std::numeric_limits<double>::quiet_NaN());
    result.registration.covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

std::vector<PairResult> solve_pairs(const std::vector<RegistrationPair>& pairs,
                                    const RegistrationOptions& options, RegisterFunction method) {
  std::vector<PairResult> results;
  results.reserve(pairs.size());
  for (const RegistrationPair& pair : pairs) {
    results.push_back(solve_pair(pair, options, method));
  }
  return results;
}

PairsFigures pairs_figures(const std::vector<PairResult>& results, int degrees_of_freedom) {
  PairsFigures figures{.credibility = Credibility(degrees_of_freedom)};
  for (const PairResult& result : results) {
    add_result(result, degrees_of_freedom, figures);
  }
  const auto pairs = static_cast<double>(results.size());
  figures.iterations /= pairs;
  figures.solve_us /= pairs;
  return figures;
}

}  // namespace cremed
