// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "cremed/estimator/cost/exclusive_cost.hpp"
#include "cremed/estimator/cost/mixture_cost.hpp"
#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/registration/gauss_newton.hpp"
#include "cremed/estimator/registration/predicted_motion.hpp"
#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/registration/registration_result.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Registration of two scans with Doppler (RA-L 2022) by Gauss-Newton in two stages: the paper's
/// cost with widened standard deviations, then the likelihood of RegistrationOptions. If few
/// targets are matched the search is repeated from other yaw angles. All storage is inside the
/// object; solving never allocates.
///
///     Registration registration(options, vehicle_from_radar);
///     registration.set_previous(previous_targets);
///     const RegistrationResult result = registration.solve(current_targets, dt_s);
class Registration {
 public:
  /// Gauss-Newton steps of the first stage. Source: the paper (RA-L 2022).
  static constexpr int kMaxStartIterations = 5;

  Registration(const RegistrationOptions& options, const Pose2& vehicle_from_radar);

  /// Sets the scan at the start of the motion. It must hold at least one target.
  void set_previous(const TargetSet& targets);

  /// The motion to the current scan, `dt_s` later. The search starts at zero as in the paper.
  RegistrationResult solve(const TargetSet& current, double dt_s);

  /// The same, started where the cost of the first stage is lowest among `starts` (not empty). With
  /// Likelihood::exclusive a prediction is tried first, without the first stage: it lies in the
  /// right basin if the result matches enough targets and does not depart too far.
  RegistrationResult solve(const TargetSet& current, double dt_s,
                           std::span<const Eigen::Vector3d> starts,
                           const std::optional<PredictedMotion>& predicted = std::nullopt);

 private:
  using Starts = std::span<const Eigen::Vector3d>;

  /// Both stages. `exact`: the cost of the second.
  template <typename Cost>
  RegistrationResult search(Cost& exact, Starts starts);
  Descent first_stage(Starts starts, double step_tolerance);
  template <typename Cost>
  RegistrationResult second_stage(Cost& exact, Descent descent);
  Descent best_of(Starts starts);
  void prepare_mixture();
  RegistrationResult solve_exclusive(const TargetSet& current, double dt_s, Starts starts,
                                     const std::optional<PredictedMotion>& predicted);
  RegistrationResult search_again(const Eigen::Vector3d& start, const RegistrationResult& first);
  template <typename Cost>
  [[nodiscard]] StoppingRule rule(const Cost& cost, int max_iterations,
                                  double step_tolerance) const;
  [[nodiscard]] std::int64_t evaluations() const;

  RegistrationOptions options_;
  OutlierRay ray_;
  MixtureCost mixture_;
  ExclusiveCost exclusive_;
  TargetSet previous_;
  bool is_previous_finite_ = false;
  bool has_mixture_ = false;  // mixture_ holds the previous scan
};

}  // namespace cremed
