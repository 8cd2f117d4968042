// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/registration/registration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cremed/estimator/scan/rotation.hpp"

namespace cremed {
namespace {

constexpr int kMaxHalvings = 12;

/// A search whose steps no longer lower the cost has ended if what is left of the step, squared and
/// in standard deviations, is no more than this.
constexpr double kStuckStep = 0.1;

/// How fast an acceleration of one deviation sets in: 10 m/s^3 for 3 m/s^2, as hard brakes do.
/// Doppler at both ends tells how the velocity changes in between, but not when: that moves by up
/// to jerk dt^3 / 12, 0.4 mm from scan to scan and 53 mm over a gap of 0.4 s.
constexpr double kJerkPerAcceleration = 10.0 / 3.0;

Symmetric2 operator*(double factor, const Symmetric2& m) {
  return {factor * m.xx, factor * m.xy, factor * m.yy};
}

NormalEquations operator+(const NormalEquations& a, const NormalEquations& b) {
  return {a.information + b.information, a.gradient + b.gradient, a.cost + b.cost};
}

NormalEquations operator-(const NormalEquations& a, const NormalEquations& b) {
  return {a.information - b.information, a.gradient - b.gradient, a.cost - b.cost};
}

/// In 2 DoF Doppler tells of y what the vehicle slips, 0, while the frame at the start sees the arc
/// besides: slip = y - x yaw / 2. The equations at y = 0, of y as the start sees it.
NormalEquations seen_from_start(const NormalEquations& slip, const Eigen::Vector3d& motion) {
  Eigen::Matrix3d by_motion = Eigen::Matrix3d::Identity();
  by_motion(1, 0) = -0.5 * motion.z();
  by_motion(1, 2) = -0.5 * motion.x();
  const Eigen::Vector3d arc(0.0, -0.5 * motion.x() * motion.z(), 0.0);
  return {by_motion.transpose() * slip.information * by_motion,
          by_motion.transpose() * (slip.gradient + slip.information * arc), slip.cost};
}

}  // namespace

Registration::Registration(const RegistrationOptions& options, const Pose2& vehicle_from_radar)
    : options_(options),
      vehicle_from_radar_(vehicle_from_radar),
      ray_(options.outlier_ray, vehicle_from_radar),
      shared_doppler_(options.degrees_of_freedom, options.doppler, options.shared_errors,
                      vehicle_from_radar) {}

void Registration::set_previous(const TargetSet& targets) {
  mixture_.assign(targets, ray_);
  previous_ = targets;
  is_previous_finite_ = targets.is_finite();
}

std::int64_t Registration::evaluations() const {
  return mixture_evaluations_ + likelihood_.evaluations();
}

bool Registration::is_spent() const { return evaluations() >= options_.max_component_evaluations; }

void Registration::add_doppler(const Problem& problem, const Eigen::Vector3d& motion, double scale,
                               NormalEquations& equations) const {
  if (!options_.doppler.enabled) {
    return;
  }
  for (const Target& target : problem.current) {
    const DopplerGeometry geometry(target, motion, vehicle_from_radar_);
    const DopplerResidual doppler =
        doppler_residual(target, geometry, problem.dt_s, options_.doppler, scale);
    const Eigen::RowVector3d jacobian = doppler.per_m * geometry.jacobian;
    equations.information.noalias() += jacobian.transpose() * jacobian;
    equations.gradient.noalias() += jacobian.transpose() * (doppler.per_m * doppler.error_m);
    equations.cost += doppler.cost;
  }
}

NormalEquations Registration::linearise(const TargetSet& current, double dt_s,
                                        const Eigen::Vector3d& motion, double scale,
                                        double doppler_scale) {
  const Rotation rotation(motion.z());
  for (std::size_t i = 0; i < current.size(); ++i) {
    const Target& target = current[i];
    lever_m_[i] = rotation * Eigen::Vector2d(target.x_m, target.y_m);
    points_[i] = {lever_m_[i].x() + motion.x(), lever_m_[i].y() + motion.y(),
                  rotation * (scale * scale * target.covariance_m2)};
  }
  mixture_.evaluate({points_.data(), current.size()}, {residuals_.data(), current.size()});
  NormalEquations equations;
  for (std::size_t i = 0; i < current.size(); ++i) {
    const Eigen::Matrix<double, 3, 2>& jacobian = residuals_[i].jacobian;
    equations.add_point({jacobian.col(0).squaredNorm(), jacobian.col(0).dot(jacobian.col(1)),
                         jacobian.col(1).squaredNorm()},
                        jacobian.transpose() * residuals_[i].residual, lever_m_[i]);
    equations.cost += residuals_[i].cost;
  }
  mixture_evaluations_ += static_cast<std::int64_t>(current.size() * mixture_.size());
  add_doppler({current, dt_s}, motion, doppler_scale, equations);
  return equations;
}

RegistrationStatus Registration::run_stage(const Problem& problem, const Stage& stage,
                                           RegistrationResult& result, NormalEquations& equations) {
  for (int i = 0; i < stage.max_iterations; ++i) {
    if (!std::isfinite(equations.cost)) {
      return RegistrationStatus::non_finite;
    }
    const auto inverse = invert_information(equations.information, options_.degrees_of_freedom);
    if (!inverse) {
      return RegistrationStatus::degenerate;
    }
    Eigen::Vector3d step = -*inverse * equations.gradient;
    const double squared_step = -step.dot(equations.gradient);
    if (squared_step < stage.step_tolerance) {
      return RegistrationStatus::converged;
    }
    NormalEquations trial;
    int halvings = 0;
    for (; halvings < kMaxHalvings && !is_spent(); ++halvings, step *= 0.5) {
      trial = linearise(problem.current, problem.dt_s, result.motion + step, stage.scale,
                        stage.doppler_scale);
      if (trial.cost <= equations.cost) {
        break;
      }
    }
    if (halvings == kMaxHalvings) {
      return squared_step <= kStuckStep ? RegistrationStatus::converged
                                        : RegistrationStatus::no_convergence;
    }
    if (is_spent()) {
      break;
    }
    result.motion += step;
    equations = trial;
    ++result.iterations;
  }
  return RegistrationStatus::no_convergence;
}

NormalEquations Registration::linearise_exclusive(const Problem& problem,
                                                  const Eigen::Vector3d& motion, bool settle) {
  NormalEquations equations = likelihood_.linearise(previous_, problem.current, motion, settle);
  if (options_.doppler.enabled) {
    shared_doppler_.add(previous_, problem.current, motion, problem.dt_s, equations);
  }
  return equations;
}

RegistrationStatus Registration::climb(const Problem& problem, RegistrationResult& result,
                                       NormalEquations& equations) {
  // How far targets have moved since pairs were listed, in standard deviations.
  double moved = std::numeric_limits<double>::infinity();
  bool settle = false;
  for (int steps = 0; steps < options_.max_iterations && !is_spent();) {
    if (moved > 0.5 * ExclusiveLikelihood::kListReach) {
      if (!likelihood_.list_pairs(previous_, problem.current, result.motion)) {
        return RegistrationStatus::ambiguous;
      }
      moved = 0.0;
    }
    equations = linearise_exclusive(problem, result.motion, settle);
    if (!std::isfinite(equations.cost)) {
      return RegistrationStatus::non_finite;
    }
    const auto inverse = invert_information(equations.information, options_.degrees_of_freedom);
    if (!inverse) {
      return RegistrationStatus::degenerate;
    }
    const Eigen::Vector3d step = -*inverse * equations.gradient;
    const double squared_step = -step.dot(equations.gradient);
    if (squared_step < options_.step_tolerance) {
      if (likelihood_.is_settled()) {
        return RegistrationStatus::converged;
      }
      settle = true;
      continue;
    }
    // The sum over all targets: the one found again moves by its root mean square.
    moved += std::sqrt(squared_step / std::max(likelihood_.matched(), 1.0));
    result.motion += step;
    ++result.iterations;
    ++steps;
  }
  return RegistrationStatus::no_convergence;
}

/// Errors that no measurement of the two scans shows: of the scale of Doppler, of jerk, and of the
/// radar's own velocity over the vehicle's.
void Registration::add_unseen_errors(const Problem& problem, RegistrationResult& result) const {
  const SharedErrorOptions& errors = options_.shared_errors;
  const bool by_doppler = options_.doppler.enabled;  // Positions show scale and jerk.
  const double scale_std = by_doppler ? errors.doppler_scale_std : 0.0;
  const double by_scale_m = scale_std * result.motion.x();
  const double sideways_by_scale_m = scale_std * result.motion.y();
  result.covariance(0, 0) += by_scale_m * by_scale_m;
  result.covariance(1, 1) += sideways_by_scale_m * sideways_by_scale_m;
  result.covariance(0, 1) += by_scale_m * sideways_by_scale_m;
  result.covariance(1, 0) = result.covariance(0, 1);
  const double noise_m = std::sqrt(result.covariance(0, 0));
  const double by_velocity_m =
      rolling_part(result.motion, noise_m, problem.dt_s) * errors.velocity_std_mps * problem.dt_s;
  const double by_jerk_m = by_doppler ? kJerkPerAcceleration * errors.acceleration_std_mps2 *
                                            std::pow(problem.dt_s, 3) / 12.0
                                      : 0.0;
  const double variance_m2 = by_velocity_m * by_velocity_m + by_jerk_m * by_jerk_m;
  result.covariance(0, 0) += variance_m2;
  result.covariance(1, 1) += options_.degrees_of_freedom == 3 ? variance_m2 : 0.0;
}

void Registration::finish_exclusive(const Problem& problem, RegistrationResult& result) {
  NormalEquations equations;
  shared_doppler_.start();
  result.status = climb(problem, result, equations);
  result.cost = equations.cost;
  result.matched = likelihood_.matched();
  const int states = options_.degrees_of_freedom;
  const auto complete = invert_information(equations.information, states);
  if (!result.has_motion() || !complete) {
    return;
  }
  const Eigen::Vector3d sigma = complete->diagonal().cwiseSqrt();
  const auto observed =
      invert_information(equations.information - likelihood_.missing_information(sigma), states);
  if (observed) {
    result.covariance = *observed;
    keep_equations(problem, equations, result);
    add_unseen_errors(problem, result);
  } else {
    result.status = RegistrationStatus::degenerate;
  }
}

/// With positions p and Doppler d, at a motion where their gradients g_p and g_d cancel: each by
/// itself would go H^-1 g away from it, and the covariance of that difference is H_p^-1 + H_d^-1.
void Registration::keep_equations(const Problem& problem, const NormalEquations& equations,
                                  RegistrationResult& result) {
  NormalEquations doppler;
  if (options_.doppler.enabled) {
    shared_doppler_.add(previous_, problem.current, result.motion, problem.dt_s, doppler);
  }
  const int states = options_.degrees_of_freedom;
  const NormalEquations positions = equations - doppler;
  const auto by_doppler = invert_information(doppler.information, states);
  const auto by_position = invert_information(positions.information, states);
  if (by_doppler && by_position) {
    const Eigen::Vector3d& g = doppler.gradient;
    result.doppler_innovation = g.dot((*by_doppler + *by_position) * g) / states;
  }
  const NormalEquations free =
      states == 3 ? equations : positions + seen_from_start(doppler, result.motion);
  result.gradient = free.gradient;
  if (const auto complete = invert_information(free.information, 3)) {
    const Eigen::Vector3d sigma = complete->diagonal().cwiseSqrt();
    result.information = free.information - likelihood_.missing_information(sigma);
  }
}

void Registration::finish_gauss_newton(const Problem& problem, const Stage& stage,
                                       RegistrationResult& result, NormalEquations& equations) {
  result.status = run_stage(problem, stage, result, equations);
  result.cost = equations.cost;
  const auto covariance = invert_information(equations.information, options_.degrees_of_freedom);
  if (covariance) {
    result.covariance = *covariance;
    result.information = equations.information;
    result.gradient = equations.gradient;
  } else if (result.status != RegistrationStatus::non_finite) {
    result.status = RegistrationStatus::degenerate;
  }
}

}  // namespace cremed
