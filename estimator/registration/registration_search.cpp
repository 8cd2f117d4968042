// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cremed/estimator/registration/registration.hpp"

// Where a registration starts and when it starts again.
namespace cremed {
namespace {

/// Starts nearer than this to each other lead to the same minimum.
constexpr double kSameStartM = 0.01;
constexpr double kSameStartRad = 0.005;

/// With a smaller share of the targets found again the search may have ended in a local minimum.
constexpr double kSuspiciousShare = 0.5;
/// With a smaller one chance neighbours pass for correspondences.
constexpr double kMinShare = 0.3;
/// Where to search again, relative to the first start: the first stage's widened azimuth reaches
/// from one to the next.
constexpr std::array<double, 4> kRestartYawRad{-0.15, 0.15, -0.3, 0.3};
/// Another motion is a rival if it is farther away than this, squared and in standard deviations,
/// and its likelihood smaller by no more than a factor of this logarithm.
constexpr double kRivalSquaredDistance = 25.0;
constexpr double kRivalLogRatio = 3.0;

bool is_better(const RegistrationResult& a, const RegistrationResult& b) {
  return a.has_motion() && (!b.has_motion() || a.cost < b.cost);
}

bool is_other_motion(const Eigen::Vector3d& motion, const RegistrationResult& result,
                     int degrees_of_freedom) {
  const auto information = invert_information(result.covariance, degrees_of_freedom);
  const Eigen::Vector3d difference = motion - result.motion;
  return !information || difference.dot(*information * difference) > kRivalSquaredDistance;
}

}  // namespace

NormalEquations Registration::begin(const Problem& problem, const Stage& stage,
                                    std::span<const Eigen::Vector3d> starts,
                                    RegistrationResult& result) {
  NormalEquations best;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto is_near = [&](const Eigen::Vector3d& other) {
      return (starts[i] - other).head<2>().norm() < kSameStartM &&
             std::abs(starts[i].z() - other.z()) < kSameStartRad;
    };
    if (std::any_of(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(i), is_near)) {
      continue;
    }
    const NormalEquations equations =
        linearise(problem.current, problem.dt_s, starts[i], stage.scale, stage.doppler_scale);
    if (i == 0 || equations.cost < best.cost) {
      best = equations;
      result.motion = starts[i];
    }
  }
  return best;
}

RegistrationResult Registration::search(const Problem& problem,
                                        std::span<const Eigen::Vector3d> starts) {
  const bool is_exclusive = options_.covariance == CovarianceModel::exclusive;
  const bool has_two_stages = options_.start_scale > 1.0;
  const Stage wide{options_.start_scale, options_.start_scale * options_.start_doppler_scale,
                   options_.max_start_iterations,
                   is_exclusive ? kExclusiveStartStepTolerance : kStartStepTolerance};
  const Stage exact{1.0, 1.0, options_.max_iterations, options_.step_tolerance};
  RegistrationResult result;
  if (is_exclusive && !has_two_stages && starts.size() == 1) {
    result.motion = starts.front();
    finish_exclusive(problem, result);
    return result;
  }
  NormalEquations equations = begin(problem, has_two_stages ? wide : exact, starts, result);
  if (has_two_stages) {
    run_stage(problem, wide, result, equations);
  }
  if (is_exclusive) {
    finish_exclusive(problem, result);
    return result;
  }
  if (has_two_stages) {
    equations = linearise(problem.current, problem.dt_s, result.motion, 1.0, 1.0);
  }
  finish_gauss_newton(problem, exact, result, equations);
  return result;
}

double Registration::matched_share(const Problem& problem, const RegistrationResult& result) const {
  return result.matched / static_cast<double>(std::min(problem.current.size(), previous_.size()));
}

RegistrationResult Registration::search_again(const Problem& problem, const Eigen::Vector3d& start,
                                              const RegistrationResult& first) {
  RegistrationResult best = first;
  double rival_cost = std::numeric_limits<double>::infinity();
  int iterations = first.iterations;
  int starts = 1;
  for (const double yaw_rad : kRestartYawRad) {
    if (is_spent()) {
      best.status = RegistrationStatus::no_convergence;
      break;
    }
    const std::array<Eigen::Vector3d, 1> other{start + Eigen::Vector3d(0.0, 0.0, yaw_rad)};
    RegistrationResult result = search(problem, other);
    iterations += result.iterations;
    ++starts;
    if (is_better(result, best)) {
      std::swap(result, best);
    }
    if (result.has_motion() && is_other_motion(result.motion, best, options_.degrees_of_freedom)) {
      rival_cost = std::min(rival_cost, result.cost);
    }
  }
  if (best.has_motion() && rival_cost < best.cost + kRivalLogRatio) {
    best.status = RegistrationStatus::ambiguous;
  }
  best.iterations = iterations;
  best.starts = starts;
  return best;
}

RegistrationResult Registration::solve(const TargetSet& current, double dt_s) {
  const std::array<Eigen::Vector3d, 1> zero{Eigen::Vector3d::Zero()};
  return solve(current, dt_s, zero);
}

RegistrationResult Registration::solve(const TargetSet& current, double dt_s,
                                       std::span<const Eigen::Vector3d> starts) {
  mixture_evaluations_ = 0;
  if (!is_previous_finite_ || !current.is_finite()) {
    return {};
  }
  const Problem problem{current, dt_s};
  const bool is_exclusive = options_.covariance == CovarianceModel::exclusive;
  if (is_exclusive) {
    likelihood_.assign(previous_, current, ray_);
  }
  RegistrationResult result = search(problem, starts);
  if (is_exclusive) {
    const bool has_ended = result.status == RegistrationStatus::converged ||
                           result.status == RegistrationStatus::degenerate;
    if (options_.restarts && has_ended && matched_share(problem, result) < kSuspiciousShare) {
      result = search_again(problem, starts.front(), result);
    }
    if (result.status == RegistrationStatus::converged &&
        matched_share(problem, result) < kMinShare) {
      result.status = RegistrationStatus::ambiguous;
    }
  }
  result.component_evaluations = evaluations();
  return result;
}

}  // namespace cremed
