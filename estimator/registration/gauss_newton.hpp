// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <utility>

#include <Eigen/Core>

#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/registration/learned_curvature.hpp"
#include "cremed/estimator/registration/registration_result.hpp"

namespace cremed {

/// A negative log likelihood of the motion between two scans, such as MixtureCost and
/// ExclusiveCost. A new one takes a file in cost/ and a line in Registration::solve.
template <typename Cost>
concept RegistrationCost = requires(Cost cost, const Unknowns& at, Eigen::Vector3d motion) {
  /// Cost, gradient and information, which depend on `at` only. State between calls is a cache
  /// (lists of pairs, warm starts).
  { cost.linearise(at) } -> std::same_as<NormalEquations>;
  /// Whether the last linearisation had capacity for all relevant pairs.
  { cost.is_complete() } -> std::same_as<bool>;
  /// Whether the inner iterations of the last linearisation converged. settle() requires this from
  /// now on; steps before the minimum do not need it.
  { cost.is_settled() } -> std::same_as<bool>;
  {cost.settle()};
  /// Whether steps that raise the cost are halved.
  { Cost::kHasStepControl } -> std::convertible_to<bool>;
  /// Work since the two scans were set, in evaluations of a mixture component.
  { cost.evaluations() } -> std::same_as<std::int64_t>;
};

/// Number of step lengths tried: 1 to 1 / 2048.
inline constexpr int kMaxHalvings = 12;

/// Squared length of a step, in standard deviations, up to which rounding may hide that it lowers
/// the cost: 0.3 sigma.
inline constexpr double kMaxStuckSquaredStep = 0.1;

/// Steps shorter than this, 0.1 sigma, are mostly the last one.
inline constexpr double kLastSquaredStep = 1e-2;

/// Limit of steps by learned curvature; typical searches take four (RadarScenes 105). A search that
/// has not ended by then begins again at its start, by EM alone, with as many steps more.
inline constexpr int kMaxLearnedSteps = 30;

/// Limits that end a descent.
struct StoppingRule {
  int degrees_of_freedom;
  double step_tolerance;  ///< Squared length of a step, in standard deviations: s' H s.
  int max_iterations;
  std::int64_t max_evaluations;
};

/// The present point of a descent.
struct Descent {
  Unknowns at;
  NormalEquations equations;  ///< At `at`.
  int iterations = 0;
};

/// Takes the longest of `step`, `step` / 2, ... that does not raise the cost; false if all do.
template <RegistrationCost Cost>
bool take_step(Cost& cost, Eigen::Vector3d step, const StoppingRule& rule, Descent& descent) {
  for (int i = 0; i < kMaxHalvings && cost.evaluations() < rule.max_evaluations; ++i, step *= 0.5) {
    const Unknowns next{descent.at.motion + step, descent.equations.shared};
    const NormalEquations equations = cost.linearise(next);
    if (!Cost::kHasStepControl || equations.cost <= descent.equations.cost) {
      descent = {next, equations, descent.iterations + 1};
      return true;
    }
  }
  return false;
}

/// Gauss-Newton with step halving, from the linearisation in `descent`.
template <RegistrationCost Cost>
RegistrationStatus descend(Cost& cost, const StoppingRule& rule, Descent& descent) {
  LearnedCurvature curvature(rule.degrees_of_freedom);
  double last_squared_step = std::numeric_limits<double>::infinity();
  const Unknowns start = descent.at;
  const int last_learned = descent.iterations + kMaxLearnedSteps;
  for (int last = descent.iterations + rule.max_iterations;;) {
    if (!cost.is_complete()) {
      return RegistrationStatus::ambiguous;
    }
    if (!std::isfinite(descent.equations.cost)) {
      return RegistrationStatus::non_finite;
    }
    const NormalEquations& equations = descent.equations;
    const auto inverse = invert_information(
        Cost::kHasStepControl ? equations.information : curvature.of(equations.information),
        rule.degrees_of_freedom);
    if (!inverse) {
      return RegistrationStatus::degenerate;
    }
    const Eigen::Vector3d step = -*inverse * equations.gradient;
    const double squared_step = -step.dot(equations.gradient);
    if (squared_step >= std::exchange(last_squared_step, squared_step)) {
      curvature.stop();
    }
    if (squared_step < rule.step_tolerance) {
      if (cost.is_settled()) {
        return RegistrationStatus::converged;
      }
      cost.settle();
      descent.at.shared = equations.shared;
      descent.equations = cost.linearise(descent.at);
    } else if (descent.iterations == last) {
      return RegistrationStatus::no_convergence;
    } else {
      if (squared_step < kLastSquaredStep) {
        cost.settle();
      }
      const Eigen::Vector3d before = equations.gradient;
      if (!take_step(cost, step, rule, descent)) {
        const bool is_spent = cost.evaluations() >= rule.max_evaluations;
        return is_spent || squared_step > kMaxStuckSquaredStep ? RegistrationStatus::no_convergence
                                                               : RegistrationStatus::converged;
      }
      curvature.add(step, equations.gradient - before, equations.information);
      if (!Cost::kHasStepControl && descent.iterations == last_learned) {
        curvature.stop();
        descent.at = start;
        descent.equations = cost.linearise(start);
        last += kMaxLearnedSteps;
        last_squared_step = std::numeric_limits<double>::infinity();
      }
    }
  }
}

}  // namespace cremed
