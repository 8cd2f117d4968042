// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tools/laboratory/pairs/sum_approximation.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <ceres/autodiff_first_order_function.h>
#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/registration/registration.hpp"

namespace cremed {
namespace {

constexpr int kMaxMinimiserSteps = 200;
constexpr double kCostTolerance = 1e-10;  // relative; the Hessian wants to be at the minimum
constexpr double kHessianStep = 1e-5;     // m and rad
constexpr double kNegligible = 80.0;      // squared distance beyond the nearest that no sum notices

double value_of(double x) { return x; }
template <typename T, int N>
double value_of(const ceres::Jet<T, N>& x) {
  return x.a;
}

/// A normal density without its factor 1/sqrt(2 pi)^n.
template <typename T>
struct Density {
  T squared_distance;
  T determinant;
};

/// The cost for ceres: parameters are the free states.
template <int kStates>
class Cost {
 public:
  /// Standard deviations of the current scan are multiplied by these factors.
  Cost(const TargetSet& previous, const TargetSet& current, const RegistrationContext& context,
       double scale, double doppler_scale)
      : previous_(previous),
        current_(current),
        context_(context),
        variance_scale_(scale * scale),
        doppler_scale_(doppler_scale) {}

  template <typename T>
  bool operator()(const T* parameters, T* cost) const {
    const T& x = parameters[0];
    const T y = kStates == 3 ? parameters[1] : T(0.0);
    const T& yaw = parameters[kStates - 1];
    std::vector<Density<T>> densities;
    densities.reserve(current_.size() * previous_.size());
    for (const Target& target : current_) {
      add_target(target, x, y, yaw, densities);
    }
    *cost = minus_log_sum(densities);
    return std::isfinite(value_of(*cost));
  }

 private:
  template <typename T>
  void add_target(const Target& target, const T& x, const T& y, const T& yaw,
                  std::vector<Density<T>>& densities) const {
    using std::cos;
    using std::sin;
    const T c = cos(yaw);
    const T s = sin(yaw);
    const Symmetric2 own{target.covariance_m2.xx * variance_scale_,
                         target.covariance_m2.xy * variance_scale_,
                         target.covariance_m2.yy * variance_scale_};
    const T px = c * target.x_m - s * target.y_m + x;
    const T py = s * target.x_m + c * target.y_m + y;
    const T cs = c * s;
    const T xx = c * c * own.xx - 2.0 * cs * own.xy + s * s * own.yy;
    const T xy = cs * (own.xx - own.yy) + (c * c - s * s) * own.xy;
    const T yy = s * s * own.xx + 2.0 * cs * own.xy + c * c * own.yy;
    const Density<T> doppler = doppler_density(target, x, y, yaw);
    for (const Target& other : previous_) {
      const T ex = px - other.x_m;
      const T ey = py - other.y_m;
      const T cxx = xx + other.covariance_m2.xx;
      const T cxy = xy + other.covariance_m2.xy;
      const T cyy = yy + other.covariance_m2.yy;
      const T determinant = cxx * cyy - cxy * cxy;
      const T squared = (cyy * ex * ex - 2.0 * cxy * ex * ey + cxx * ey * ey) / determinant;
      densities.push_back({squared + doppler.squared_distance, determinant * doppler.determinant});
    }
  }

  /// The static component of estimator/cost/doppler.hpp.
  template <typename T>
  Density<T> doppler_density(const Target& target, const T& x, const T& y, const T& yaw) const {
    if (!context_.options.doppler.enabled) {
      return {T(0.0), T(1.0)};
    }
    const Pose2& mount = context_.vehicle_from_radar;
    const double c = std::cos(target.bearing_rad);
    const double s = std::sin(target.bearing_rad);
    const T sensor_x = x - yaw * mount.y_m;
    const T sensor_y = y + yaw * mount.x_m;
    const T error = -sensor_x * c - sensor_y * s - target.doppler_mps * context_.dt_s;
    const T bearing = (sensor_x * s - sensor_y * c) * target.bearing_std_rad;
    const double doppler_m = context_.dt_s * target.doppler_std_mps * doppler_scale_;
    const double stamp_m = target.doppler_mps * context_.options.doppler.stamp_std_s;
    const T variance = doppler_m * doppler_m + stamp_m * stamp_m + bearing * bearing;
    return {error * error / variance, variance};
  }

  /// Relative to the nearest, to avoid underflow.
  template <typename T>
  T minus_log_sum(const std::vector<Density<T>>& densities) const {
    using std::exp;
    using std::log;
    using std::sqrt;
    const T nearest =
        std::ranges::min_element(densities, [](const Density<T>& a, const Density<T>& b) {
          return value_of(a.squared_distance) < value_of(b.squared_distance);
        })->squared_distance;
    T sum(0.0);
    for (const Density<T>& density : densities) {
      const T distance = density.squared_distance - nearest;
      if (value_of(distance) < kNegligible) {
        sum += exp(-0.5 * distance) / sqrt(density.determinant);
      }
    }
    return 0.5 * nearest - log(sum) + constant();
  }

  /// Factors common to all densities: weight 1/F, 2 pi of the point and sqrt(2 pi) of Doppler.
  [[nodiscard]] double constant() const {
    const double two_pi = 2.0 * std::numbers::pi;
    return std::log(static_cast<double>(previous_.size()) * two_pi) +
           (context_.options.doppler.enabled ? 0.5 * std::log(two_pi) : 0.0);
  }

  const TargetSet& previous_;
  const TargetSet& current_;
  const RegistrationContext& context_;
  double variance_scale_;
  double doppler_scale_;
};

template <int kStates>
using Function = ceres::AutoDiffFirstOrderFunction<Cost<kStates>, kStates>;

template <int kStates>
using States = Eigen::Matrix<double, kStates, 1>;

/// Indices of the estimated states: (x, yaw) in 2 DoF, (x, y, yaw) in 3.
template <int kStates>
std::vector<Eigen::Index> free_states() {
  return kStates == 2 ? std::vector<Eigen::Index>{0, 2} : std::vector<Eigen::Index>{0, 1, 2};
}

template <int kStates>
Eigen::Matrix3d hessian(const Function<kStates>& function, const States<kStates>& at) {
  Eigen::Matrix<double, kStates, kStates> block;
  for (int k = 0; k < kStates; ++k) {
    double cost = 0.0;
    States<kStates> above = States<kStates>::Zero();
    States<kStates> below = States<kStates>::Zero();
    const States<kStates> offset = kHessianStep * States<kStates>::Unit(k);
    function.Evaluate(States<kStates>(at + offset).data(), &cost, above.data());
    function.Evaluate(States<kStates>(at - offset).data(), &cost, below.data());
    block.col(k) = (above - below) / (2.0 * kHessianStep);
  }
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  const auto states = free_states<kStates>();
  result(states, states) = 0.5 * (block + block.transpose());
  return result;
}

/// BFGS from `states`, which become the minimum.
template <int kStates>
ceres::GradientProblemSolver::Summary minimise(std::unique_ptr<Cost<kStates>> cost,
                                               int max_iterations, States<kStates>& states) {
  const ceres::GradientProblem problem(new Function<kStates>(cost.release()));  // owns both
  ceres::GradientProblemSolver::Options options;
  options.line_search_direction_type = ceres::BFGS;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = kCostTolerance;
  options.logging_type = ceres::SILENT;
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(options, problem, states.data(), &summary);
  return summary;
}

int iterations(const ceres::GradientProblemSolver::Summary& summary) {
  return static_cast<int>(summary.iterations.size()) - 1;  // the first is the start
}

template <int kStates>
RegistrationResult solve(const TargetSet& previous, const TargetSet& current,
                         const RegistrationContext& context) {
  const RegistrationOptions& options = context.options;
  const auto cost = [&](double scale, double doppler_scale) {
    return std::make_unique<Cost<kStates>>(previous, current, context, scale, doppler_scale);
  };
  RegistrationResult result;
  States<kStates> states = States<kStates>::Zero();
  if (options.start_scale > 1.0) {
    result.iterations += iterations(minimise<kStates>(
        cost(options.start_scale, options.start_scale * options.start_doppler_scale),
        Registration::kMaxStartIterations, states));
  }
  const auto summary = minimise<kStates>(cost(1.0, 1.0), kMaxMinimiserSteps, states);
  result.iterations += iterations(summary);
  if (summary.termination_type == ceres::FAILURE || !states.allFinite()) {
    return result;  // non_finite
  }
  result.motion(free_states<kStates>()) = states;
  result.cost = summary.final_cost;
  const Function<kStates> function(cost(1.0, 1.0).release());
  const auto covariance = invert_information(hessian<kStates>(function, states), kStates);
  if (!covariance) {
    result.status = RegistrationStatus::degenerate;
    return result;
  }
  result.covariance = *covariance;
  result.status = summary.termination_type == ceres::CONVERGENCE
                      ? RegistrationStatus::converged
                      : RegistrationStatus::no_convergence;
  return result;
}

}  // namespace

double sum_approximation_cost(const TargetSet& previous, const TargetSet& current,
                              const RegistrationContext& context, const Eigen::Vector3d& motion) {
  double cost = 0.0;
  Cost<3>(previous, current, context, 1.0, 1.0)(motion.data(), &cost);
  return cost;
}

RegistrationResult register_sum_approximation(const TargetSet& previous, const TargetSet& current,
                                              const RegistrationContext& context) {
  return context.options.degrees_of_freedom == 2 ? solve<2>(previous, current, context)
                                                 : solve<3>(previous, current, context);
}

}  // namespace cremed
