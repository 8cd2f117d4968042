// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/registration/registration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace cremed {
namespace {

/// Starts nearer than this to each other lead to the same minimum: the distance is within the
/// errors of a registration (0.01 m, 0.001 rad) or the widened noise of the first stage.
constexpr double kSameStartM = 0.01;
constexpr double kSameStartRad = 0.005;

/// With a smaller share of matched targets the search may have ended in a local minimum and is
/// repeated. Of 1032 pairs of successive scans (nuScenes, front radar) none has less, and 1 % have
/// less than 0.62; of pairs of scans from different places 0.1 % have more.
constexpr double kRestartMatchedShare = 0.5;
/// With fewer targets a full search is cheap, and a minimum near the prediction may be another.
constexpr double kMinPredictedTargets = 20.0;
/// With a smaller share after all searches the matches are chance neighbours. Of pairs from
/// different places 5 to 26 % have more and are left to the test for a rival.
constexpr double kMinMatchedShare = 0.3;
/// Yaw of the repeated searches, relative to the first start. The spacing is 2 sigma of the first
/// stage's widened azimuth (5 times 0.0157 rad).
constexpr std::array<double, 4> kRestartYawRad{-0.15, 0.15, -0.3, 0.3};
/// Another motion is a rival if its squared distance in standard deviations is larger than this (5
/// sigma; the same minimum found twice differs by at most 0.3 sigma, kMaxStuckSquaredStep), and its
/// cost is higher by less than this: a likelihood ratio of 20, so that at most 5 % of the motions
/// without a rival are the wrong one of two.
constexpr double kMinRivalSquaredDistance = 25.0;
constexpr double kMaxRivalLogRatio = 3.0;

bool is_same_start(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).head<2>().norm() < kSameStartM && std::abs(a.z() - b.z()) < kSameStartRad;
}

bool is_better(const RegistrationResult& a, const RegistrationResult& b) {
  return a.has_motion() && (!b.has_motion() || a.cost < b.cost);
}

bool is_other_motion(const Eigen::Vector3d& motion, const RegistrationResult& result,
                     int degrees_of_freedom) {
  const auto information = invert_information(result.covariance, degrees_of_freedom);
  const Eigen::Vector3d difference = motion - result.motion;
  return !information || difference.dot(*information * difference) > kMinRivalSquaredDistance;
}

}  // namespace

Registration::Registration(const RegistrationOptions& options, const Pose2& vehicle_from_radar)
    : options_(options),
      ray_(options.outlier_ray, vehicle_from_radar),
      mixture_(options.degrees_of_freedom, options.doppler, vehicle_from_radar),
      exclusive_(options.degrees_of_freedom, options.doppler, options.shared_errors,
                 vehicle_from_radar) {}

void Registration::set_previous(const TargetSet& targets) {
  previous_ = targets;
  has_mixture_ = false;
  is_previous_finite_ = targets.is_finite();
}

RegistrationResult Registration::solve(const TargetSet& current, double dt_s) {
  const std::array<Eigen::Vector3d, 1> zero{Eigen::Vector3d::Zero()};
  return solve(current, dt_s, zero);
}

RegistrationResult Registration::solve(const TargetSet& current, double dt_s, Starts starts,
                                       const std::optional<PredictedMotion>& predicted) {
  if (!is_previous_finite_ || !current.is_finite()) {
    return {};
  }
  mixture_.set_current(current, dt_s);
  RegistrationResult result = options_.likelihood == Likelihood::exclusive
                                  ? solve_exclusive(current, dt_s, starts, predicted)
                                  : search(mixture_, starts);
  result.component_evaluations = evaluations();
  return result;
}

RegistrationResult Registration::solve_exclusive(const TargetSet& current, double dt_s,
                                                 Starts starts,
                                                 const std::optional<PredictedMotion>& predicted) {
  exclusive_.set_scans(previous_, current, dt_s, ray_);
  const auto possible = static_cast<double>(std::min(current.size(), previous_.size()));
  const auto matches_few = [&](const RegistrationResult& result) {
    return result.matched < kRestartMatchedShare * possible;
  };
  const bool is_predicted = predicted && possible >= kMinPredictedTargets;
  const auto is_expected = [&](const RegistrationResult& result) {
    return is_predicted && predicted->continued.allows(result);
  };
  int iterations = 0;
  if (is_predicted) {
    RegistrationResult result = second_stage(exclusive_, {{predicted->motion}, {}});
    if (result.status == RegistrationStatus::converged && !matches_few(result) &&
        is_expected(result)) {
      return result;
    }
    iterations = result.iterations;
  }
  RegistrationResult result = search(exclusive_, starts);
  result.iterations += iterations;
  const bool has_ended = result.status == RegistrationStatus::converged ||
                         result.status == RegistrationStatus::degenerate;
  if (has_ended && matches_few(result) && !is_expected(result)) {
    result = search_again(starts.front(), result);
  }
  if (result.status == RegistrationStatus::converged &&
      result.matched < kMinMatchedShare * possible) {
    result.status = RegistrationStatus::ambiguous;
  }
  return result;
}

template <typename Cost>
RegistrationResult Registration::search(Cost& exact, Starts starts) {
  prepare_mixture();
  return second_stage(exact, first_stage(starts, Cost::kStartTolerance));
}

void Registration::prepare_mixture() {
  if (!has_mixture_) {
    mixture_.set_previous(previous_, ray_);
    has_mixture_ = true;
  }
}

Descent Registration::first_stage(Starts starts, double step_tolerance) {
  const bool is_wide = options_.start_scale > 1.0;
  if (!is_wide && starts.size() == 1) {
    return {{starts.front()}, {}};
  }
  if (is_wide) {
    mixture_.set_scales(options_.start_scale, options_.start_scale * options_.start_doppler_scale);
  }
  Descent descent = best_of(starts);
  if (is_wide) {
    descend(mixture_, rule(mixture_, kMaxStartIterations, step_tolerance), descent);
    mixture_.set_scales(1.0, 1.0);
  }
  return descent;
}

Descent Registration::best_of(Starts starts) {
  Descent best{{starts.front()}, mixture_.linearise({starts.front()})};
  for (auto start = starts.begin() + 1; start < starts.end(); ++start) {
    const auto is_same = [&](const Eigen::Vector3d& other) { return is_same_start(*start, other); };
    if (std::any_of(starts.begin(), start, is_same)) {
      continue;
    }
    const NormalEquations equations = mixture_.linearise({*start});
    if (equations.cost < best.equations.cost) {
      best = {{*start}, equations};
    }
  }
  return best;
}

template <typename Cost>
RegistrationResult Registration::second_stage(Cost& exact, Descent descent) {
  RegistrationResult result;
  result.status = RegistrationStatus::no_convergence;
  const bool has_work_left = evaluations() < options_.max_component_evaluations;
  if (has_work_left) {
    exact.start();
    descent.equations = exact.linearise(descent.at);
    result.status =
        descend(exact, rule(exact, options_.max_iterations, Cost::kStepTolerance), descent);
    result.cost = descent.equations.cost;
    result.matched = exact.matched();
  }
  result.motion = descent.at.motion;
  result.iterations = descent.iterations;
  if (!has_work_left || !result.has_motion()) {
    return result;
  }
  if (const auto estimate = exact.estimate(descent.at, descent.equations)) {
    result.motion = estimate->motion;
    result.covariance = estimate->covariance;
    result.doppler_nis = exact.doppler_nis();
    result.by_positions = exact.by_positions(descent.at);
  } else {
    result.status = RegistrationStatus::degenerate;
  }
  return result;
}

RegistrationResult Registration::search_again(const Eigen::Vector3d& start,
                                              const RegistrationResult& first) {
  RegistrationResult best = first;
  double rival_cost = std::numeric_limits<double>::infinity();
  int iterations = first.iterations;
  int starts = 1;
  for (const double yaw_rad : kRestartYawRad) {
    if (evaluations() >= options_.max_component_evaluations) {
      best.status = RegistrationStatus::no_convergence;
      break;
    }
    const std::array<Eigen::Vector3d, 1> other{start + Eigen::Vector3d(0.0, 0.0, yaw_rad)};
    RegistrationResult result = search(exclusive_, other);
    iterations += result.iterations;
    ++starts;
    if (is_better(result, best)) {
      std::swap(result, best);
    }
    if (result.has_motion() && is_other_motion(result.motion, best, options_.degrees_of_freedom)) {
      rival_cost = std::min(rival_cost, result.cost);
    }
  }
  if (best.has_motion() && rival_cost < best.cost + kMaxRivalLogRatio) {
    best.status = RegistrationStatus::ambiguous;
  }
  best.iterations = iterations;
  best.starts = starts;
  return best;
}

template <typename Cost>
StoppingRule Registration::rule(const Cost& cost, int max_iterations, double step_tolerance) const {
  const std::int64_t by_others = evaluations() - cost.evaluations();
  return {options_.degrees_of_freedom, step_tolerance, max_iterations,
          options_.max_component_evaluations - by_others};
}

std::int64_t Registration::evaluations() const {
  return mixture_.evaluations() + exclusive_.evaluations();
}

}  // namespace cremed
