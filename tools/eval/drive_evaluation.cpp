// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive_evaluation.hpp"

#include "tools/eval/recorded_odometry.hpp"

namespace cremed {
namespace {

EstimateError compare(const RecordedEstimate& estimate, const Eigen::Vector3d& truth, int dof) {
  return {estimate.end_us, estimation_error(estimate.motion, truth),
          estimate.covariance.diagonal().cwiseSqrt(),
          normalised_error_squared(estimate.motion, estimate.covariance, truth, dof) / dof};
}

void compare_estimates(const std::vector<RecordedEstimate>& estimates, const TrueTrajectory& truth,
                       SourceEvaluation& result) {
  for (const RecordedEstimate& estimate : estimates) {
    if (const auto motion = truth.motion(estimate.start_us, estimate.end_us)) {
      result.credibility.add(estimate.motion, estimate.covariance, *motion);
      result.errors.push_back(compare(estimate, *motion, result.degrees_of_freedom));
    } else {
      ++result.outside_truth;
    }
  }
}

std::vector<RunningNees> mean_nees(const std::vector<EstimateError>& errors, int dof) {
  std::vector<TimedNees> nees;
  nees.reserve(errors.size());
  for (const EstimateError& error : errors) {
    nees.push_back({error.utime_us, error.nees});
  }
  return running_nees(nees, dof, kNeesWindowUs);
}

SourceEvaluation evaluate_source(const RecordedOdometry& odometry, const TrueTrajectory& truth) {
  SourceEvaluation result;
  result.source = odometry.source;
  result.degrees_of_freedom = degrees_of_freedom(odometry);
  result.credibility = Credibility(result.degrees_of_freedom);
  result.without_estimate = odometry.without_estimate;
  compare_estimates(odometry.estimates, truth, result);
  result.mean_nees = mean_nees(result.errors, result.degrees_of_freedom);
  result.path = driven_path(odometry.estimates, truth);
  result.drift = path_drift(result.path);
  return result;
}

}  // namespace

std::vector<SourceEvaluation> evaluate_drive(std::istream& odometry, const TrueTrajectory& truth) {
  std::vector<SourceEvaluation> result;
  for (const RecordedOdometry& source : read_odometry(odometry)) {
    result.push_back(evaluate_source(source, truth));
  }
  return result;
}

}  // namespace cremed
