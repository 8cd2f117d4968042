// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/eval/drive/drive_evaluation.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>

#include "daemon/configuration/configuration.hpp"
#include "tools/eval/csv_table.hpp"
#include "tools/eval/drive/pose_windows.hpp"
#include "tools/eval/drive/recorded_odometry.hpp"
#include "tools/eval/drive/recorded_states.hpp"

namespace cremed {
namespace {

MeanRates mean_rates(const Eigen::Vector3d& motion, double seconds) {
  return {motion.x() / seconds, motion.z() / seconds};
}

EstimateError compare(const RecordedEstimate& estimate, const Eigen::Vector3d& truth, int dof) {
  const double seconds = static_cast<double>(estimate.end_us - estimate.start_us) * 1e-6;
  return {estimate.end_us,
          estimation_error(estimate.motion, truth),
          estimate.covariance.diagonal().cwiseSqrt(),
          normalised_error_squared(estimate.motion, estimate.covariance, truth, dof) / dof,
          mean_rates(estimate.motion, seconds),
          mean_rates(truth, seconds)};
}

void compare_estimates(const std::vector<RecordedEstimate>& estimates,
                       const DriveReference& reference, SourceEvaluation& result) {
  for (RecordedEstimate estimate : estimates) {
    estimate.covariance += reference.truth_noise.covariance(estimate.end_us - estimate.start_us);
    if (const auto motion = reference.truth.motion(estimate.start_us, estimate.end_us)) {
      result.credibility.add(estimate.motion, estimate.covariance, *motion);
      result.errors.push_back(compare(estimate, *motion, result.degrees_of_freedom));
    } else {
      ++result.outside_truth;
    }
  }
}

}  // namespace

std::vector<RunningNees> running_nees(const std::vector<EstimateError>& estimates,
                                      int degrees_of_freedom) {
  std::vector<RunningNees> result;
  std::map<std::size_t, Interval> intervals;  // By count: of a few sizes, and slow to compute.
  auto begin = estimates.begin();
  auto end = begin;
  for (const EstimateError& centre : estimates) {
    begin = std::find_if(begin, estimates.end(), [&](const EstimateError& e) {
      return e.utime_us >= centre.utime_us - kNeesWindowUs / 2;
    });
    end = std::find_if(end, estimates.end(), [&](const EstimateError& e) {
      return e.utime_us > centre.utime_us + kNeesWindowUs / 2;
    });
    const auto count = static_cast<std::size_t>(end - begin);
    const double sum = std::accumulate(
        begin, end, 0.0, [](double total, const EstimateError& e) { return total + e.nees; });
    const auto [interval, is_new] = intervals.try_emplace(count);
    if (is_new) {
      interval->second = anees_interval(count, degrees_of_freedom, 0.95);
    }
    result.push_back({sum / static_cast<double>(count), interval->second});
  }
  return result;
}

SourceEvaluation evaluate_source(const RecordedOdometry& odometry, const DriveReference& reference,
                                 std::int64_t first_window_us) {
  SourceEvaluation result;
  result.first_window_us = first_window_us;
  result.source = odometry.source;
  result.degrees_of_freedom = degrees_of_freedom(odometry);
  result.credibility = Credibility(result.degrees_of_freedom);
  if (!odometry.estimates.empty()) {
    result.time = {odometry.estimates.front().start_us, odometry.estimates.back().end_us};
  }
  result.availability = odometry.availability;
  result.without_estimate = odometry.without_estimate;
  compare_estimates(odometry.estimates, reference, result);
  result.mean_nees = running_nees(result.errors, result.degrees_of_freedom);
  result.path = driven_path(odometry.steps(), reference.truth);
  result.drift = path_drift(result.path);
  result.segments =
      trajectory_segments(odometry, reference.truth, reference.truth_noise, first_window_us);
  if (reference.wheels) {
    result.wheels = against_wheels(odometry.estimates, reference.truth, *reference.wheels);
  }
  return result;
}

namespace {

SourceEvaluation evaluate_states(const RecordedStates& states, const DriveReference& reference) {
  SourceEvaluation result = evaluate_source(states.odometry, reference,
                                            first_window_us({states.odometry}, reference.truth));
  if (reference.wheels) {
    result.twist = against_wheels(states.states, *reference.wheels);
  }
  return result;
}

}  // namespace

std::vector<SourceEvaluation> evaluate_drive(std::istream& odometry,
                                             const DriveReference& reference) {
  const CsvTable table(odometry);
  if (!table.has_column("status")) {
    throw std::runtime_error("this is no odometry of cremed; ODOMETRY comes before TRUTH");
  }
  if (holds_states(table)) {
    return {evaluate_states(read_states(table), reference)};
  }
  const std::vector<RecordedOdometry> sources = read_odometry(table);
  std::vector<SourceEvaluation> result;
  result.reserve(sources.size());
  const std::int64_t first_us = first_window_us(sources, reference.truth);
  for (const RecordedOdometry& source : sources) {
    result.push_back(evaluate_source(source, reference, first_us));
  }
  std::stable_partition(result.begin(), result.end(), [](const SourceEvaluation& source) {
    return source.source == kFusedSource;
  });
  return result;
}

}  // namespace cremed
