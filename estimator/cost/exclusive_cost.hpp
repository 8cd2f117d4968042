// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/cost/exclusive_likelihood.hpp"
#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/cost/shared_doppler.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Positions by ExclusiveLikelihood and Doppler by SharedDoppler. For given probabilities of the
/// pairs, -log L of the positions is a sum of squares that touches their cost from above: a
/// Gauss-Newton step, which goes to its minimum, is one of EM. All storage is inside the object.
class ExclusiveCost {
 public:
  ExclusiveCost(int degrees_of_freedom, const DopplerOptions& doppler,
                const SharedErrorOptions& errors, const Pose2& vehicle_from_radar);

  /// Two scans, none of them empty, which are used until the next.
  void set_scans(const TargetSet& previous, const TargetSet& current, double dt_s,
                 const OutlierRay& ray);
  /// Begins a search: nothing is taken over from the one before.
  void start();
  /// As of MixtureCost: less is asked of the first stage, as EM's steps find the way from farther.
  static constexpr double kStartTolerance = 0.1;

  NormalEquations linearise(const Unknowns& at);
  /// Steps of the positions never raise their cost (EM, see above). With Doppler the costs of two
  /// motions cannot be compared: which targets count as moving is judged by the shared errors of
  /// the motion before.
  static constexpr bool kHasStepControl = false;
  [[nodiscard]] bool is_complete() const { return is_complete_; }
  [[nodiscard]] bool is_settled() const { return likelihood_.is_settled(); }
  void settle() { settle_ = true; }
  [[nodiscard]] std::int64_t evaluations() const { return likelihood_.evaluations(); }

  // Of the last linearisation, at `at`:

  /// Inverse of the curvature of -log L, and the errors that no measurement shows.
  [[nodiscard]] std::optional<Eigen::Matrix3d> covariance(const Unknowns& at,
                                                          const NormalEquations& equations);
  /// Expected number of targets found again.
  [[nodiscard]] double matched() const { return likelihood_.matched(); }
  /// RegistrationResult::doppler_innovation. With positions p and Doppler d, at a motion where
  /// their gradients g_p and g_d cancel: each by itself would go H^-1 g away from it, and the
  /// covariance of that difference is H_p^-1 + H_d^-1.
  [[nodiscard]] double doppler_innovation() const;

 private:
  /// Lists the pairs again if targets may have moved out of the last list's reach.
  void update_list(const Eigen::Vector3d& motion);

  int degrees_of_freedom_;
  bool has_doppler_;
  SharedErrorOptions errors_;
  SharedDoppler shared_doppler_;
  ExclusiveLikelihood likelihood_;
  const TargetSet* previous_ = nullptr;
  const TargetSet* current_ = nullptr;
  double dt_s_ = 0.0;
  bool settle_ = false;
  bool is_complete_ = true;
  /// How far targets have moved since pairs were listed, in standard deviations.
  double moved_ = 0.0;
  // The last linearisation.
  Eigen::Vector3d motion_ = Eigen::Vector3d::Zero();
  NormalEquations positions_;
  NormalEquations doppler_;
};

}  // namespace cremed
