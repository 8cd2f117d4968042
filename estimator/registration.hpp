// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "estimator/doppler.hpp"
#include "estimator/mixture.hpp"
#include "estimator/outlier_ray.hpp"
#include "estimator/pose2.hpp"
#include "estimator/registration_options.hpp"
#include "estimator/target_set.hpp"

namespace cremed {

/// How a registration ended.
enum class RegistrationStatus : std::uint8_t {
  converged,       ///< Step below kStepTolerance, or no step lowers the cost.
  degenerate,      ///< J'J is not positive definite: the targets do not fix all states.
  no_convergence,  ///< max_iterations steps without either.
  non_finite,      ///< The cost is not a number: the input was out of any range.
};

/// Gauss-Newton's normal equations at one motion, all three states.
struct NormalEquations {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< J'J
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();     ///< J'r
  double cost = 0.0;
};

/// The ego-motion between two scans: pose of the vehicle at the current scan in its frame at the
/// previous scan, order (x_m, y_m, yaw_rad).
struct RegistrationResult {
  RegistrationStatus status = RegistrationStatus::non_finite;
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< (J'J)^-1; y row and column 0 in 2 DoF.
  double cost = 0.0;                                     ///< Negative log likelihood + constant.
  int iterations = 0;                                    ///< Gauss-Newton steps of both stages.
};

/// Max-Sum-Mixture registration of two scans with Doppler (RA-L 2022), Gauss-Newton with step
/// halving. All storage is inside the object: solving never allocates.
///
///     Registration registration(options, vehicle_from_radar);
///     registration.set_previous(previous_targets);
///     const RegistrationResult result = registration.solve(current_targets, dt_s);
class Registration {
 public:
  /// A stage ends at a step shorter than this, squared, in standard deviations (step' J'J step).
  /// The first stage only has to end near enough for the second.
  static constexpr double kStepTolerance = 1e-5;
  static constexpr double kStartStepTolerance = 1e-2;

  Registration(const RegistrationOptions& options, const Pose2& vehicle_from_radar);

  /// The scan that the motion starts at; must hold at least one target.
  void set_previous(const TargetSet& targets);

  /// The motion to the current scan, `dt_s` later; starts at zero as the paper does.
  RegistrationResult solve(const TargetSet& current, double dt_s);

  /// The same, started where the cost of the first stage is lowest among `starts` (not empty).
  RegistrationResult solve(const TargetSet& current, double dt_s,
                           std::span<const Eigen::Vector3d> starts);

  /// Cost and normal equations at a given motion, with true standard deviations (scale 1) or those
  /// of the first stage.
  NormalEquations linearise(const TargetSet& current, double dt_s, const Eigen::Vector3d& motion,
                            double scale, double doppler_scale);

 private:
  struct Stage {
    double scale;
    double doppler_scale;
    int max_iterations;
    double step_tolerance;
  };
  /// The equations at the best of the starts, which goes to `motion`.
  NormalEquations begin(const TargetSet& current, double dt_s, const Stage& stage,
                        std::span<const Eigen::Vector3d> starts, Eigen::Vector3d& motion);
  /// Gauss-Newton from result.motion, where `equations` are given, until the stage's end.
  RegistrationStatus run_stage(const TargetSet& current, double dt_s, const Stage& stage,
                               RegistrationResult& result, NormalEquations& equations);

  RegistrationOptions options_;
  Pose2 vehicle_from_radar_;
  OutlierRay ray_;
  Mixture mixture_;
};

}  // namespace cremed
