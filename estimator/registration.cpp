// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/registration.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

namespace cremed {
namespace {

constexpr int kMaxHalvings = 12;

/// Starts nearer than this to each other lead to the same minimum.
constexpr double kSameStartM = 0.1;
constexpr double kSameStartRad = 0.05;

/// Index of the free states: (x, yaw) or (x, y, yaw).
const std::array<Eigen::Index, 3>& free_states(int degrees_of_freedom) {
  static constexpr std::array<Eigen::Index, 3> kTwo{0, 2, 2};
  static constexpr std::array<Eigen::Index, 3> kThree{0, 1, 2};
  return degrees_of_freedom == 2 ? kTwo : kThree;
}

using FreeMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// Inverse of the free block of J'J, zeros elsewhere; nothing if it is not positive definite.
std::optional<Eigen::Matrix3d> invert_information(const Eigen::Matrix3d& information,
                                                  int degrees_of_freedom) {
  const auto& states = free_states(degrees_of_freedom);
  FreeMatrix block(degrees_of_freedom, degrees_of_freedom);
  for (Eigen::Index i = 0; i < degrees_of_freedom; ++i) {
    for (Eigen::Index j = 0; j < degrees_of_freedom; ++j) {
      block(i, j) =
          information(states[static_cast<std::size_t>(i)], states[static_cast<std::size_t>(j)]);
    }
  }
  const Eigen::LLT<FreeMatrix> factor(block);
  if (factor.info() != Eigen::Success || !(factor.rcond() > 1e-14)) {
    return std::nullopt;
  }
  const FreeMatrix inverse =
      factor.solve(FreeMatrix::Identity(degrees_of_freedom, degrees_of_freedom));
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < degrees_of_freedom; ++i) {
    for (Eigen::Index j = 0; j < degrees_of_freedom; ++j) {
      result(states[static_cast<std::size_t>(i)], states[static_cast<std::size_t>(j)]) =
          inverse(i, j);
    }
  }
  return result;
}

/// R S R'.
Symmetric2 rotate(const Symmetric2& m, double c, double s) {
  return {c * c * m.xx - 2.0 * c * s * m.xy + s * s * m.yy,
          c * s * (m.xx - m.yy) + (c * c - s * s) * m.xy,
          s * s * m.xx + 2.0 * c * s * m.xy + c * c * m.yy};
}

}  // namespace

Registration::Registration(const RegistrationOptions& options, const Pose2& vehicle_from_radar)
    : options_(options),
      vehicle_from_radar_(vehicle_from_radar),
      ray_(options.outlier_ray, vehicle_from_radar) {}

void Registration::set_previous(const TargetSet& targets) { mixture_.assign(targets, ray_); }

NormalEquations Registration::linearise(const TargetSet& current, double dt_s,
                                        const Eigen::Vector3d& motion, double scale,
                                        double doppler_scale) {
  NormalEquations equations;
  const double c = std::cos(motion.z());
  const double s = std::sin(motion.z());
  const double variance_scale = scale * scale;
  for (const Target& target : current) {
    const Eigen::Vector2d rotated(c * target.x_m - s * target.y_m, s * target.x_m + c * target.y_m);
    const Symmetric2& covariance = target.covariance_m2;
    const MixtureResidual point =
        mixture_.evaluate(rotated + motion.head<2>(),
                          rotate({covariance.xx * variance_scale, covariance.xy * variance_scale,
                                  covariance.yy * variance_scale},
                                 c, s));
    Eigen::Matrix<double, 3, 3> jacobian;
    jacobian.leftCols<2>() = point.jacobian;
    jacobian.col(2) = point.jacobian * Eigen::Vector2d(-rotated.y(), rotated.x());
    equations.information.noalias() += jacobian.transpose() * jacobian;
    equations.gradient.noalias() += jacobian.transpose() * point.residual;
    equations.cost += point.cost;
    if (options_.doppler.enabled) {
      const DopplerResidual doppler = doppler_residual(target, motion, vehicle_from_radar_, dt_s,
                                                       options_.doppler, doppler_scale);
      equations.information.noalias() += doppler.jacobian.transpose() * doppler.jacobian;
      equations.gradient.noalias() += doppler.jacobian.transpose() * doppler.residual;
      equations.cost += doppler.cost;
    }
  }
  return equations;
}

RegistrationStatus Registration::run_stage(const TargetSet& current, double dt_s,
                                           const Stage& stage, RegistrationResult& result,
                                           NormalEquations& equations) {
  for (int i = 0; i < stage.max_iterations; ++i) {
    if (!std::isfinite(equations.cost)) {
      return RegistrationStatus::non_finite;
    }
    const auto inverse = invert_information(equations.information, options_.degrees_of_freedom);
    if (!inverse) {
      return RegistrationStatus::degenerate;
    }
    Eigen::Vector3d step = -*inverse * equations.gradient;
    if (step.dot(-equations.gradient) < stage.step_tolerance) {
      return RegistrationStatus::converged;
    }
    NormalEquations trial;
    int halvings = 0;
    for (; halvings < kMaxHalvings; ++halvings, step *= 0.5) {
      trial = linearise(current, dt_s, result.motion + step, stage.scale, stage.doppler_scale);
      if (trial.cost <= equations.cost) {
        break;
      }
    }
    if (halvings == kMaxHalvings) {
      return RegistrationStatus::converged;
    }
    result.motion += step;
    equations = trial;
    ++result.iterations;
  }
  return RegistrationStatus::no_convergence;
}

NormalEquations Registration::begin(const TargetSet& current, double dt_s, const Stage& stage,
                                    std::span<const Eigen::Vector3d> starts,
                                    Eigen::Vector3d& motion) {
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
        linearise(current, dt_s, starts[i], stage.scale, stage.doppler_scale);
    if (i == 0 || equations.cost < best.cost) {
      best = equations;
      motion = starts[i];
    }
  }
  return best;
}

RegistrationResult Registration::solve(const TargetSet& current, double dt_s) {
  const std::array<Eigen::Vector3d, 1> zero{Eigen::Vector3d::Zero()};
  return solve(current, dt_s, zero);
}

RegistrationResult Registration::solve(const TargetSet& current, double dt_s,
                                       std::span<const Eigen::Vector3d> starts) {
  const Stage wide{options_.start_scale, options_.start_scale * options_.start_doppler_scale,
                   options_.max_start_iterations, kStartStepTolerance};
  const Stage exact{1.0, 1.0, options_.max_iterations, kStepTolerance};
  const bool has_two_stages = options_.start_scale > 1.0;
  RegistrationResult result;
  NormalEquations equations =
      begin(current, dt_s, has_two_stages ? wide : exact, starts, result.motion);
  if (has_two_stages) {
    run_stage(current, dt_s, wide, result, equations);
    equations = linearise(current, dt_s, result.motion, exact.scale, exact.doppler_scale);
  }
  result.status = run_stage(current, dt_s, exact, result, equations);
  result.cost = equations.cost;
  const auto covariance = invert_information(equations.information, options_.degrees_of_freedom);
  if (covariance) {
    result.covariance = *covariance;
  } else if (result.status != RegistrationStatus::non_finite) {
    result.status = RegistrationStatus::degenerate;
  }
  return result;
}

}  // namespace cremed
