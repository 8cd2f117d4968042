// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include <Eigen/Core>

#include "cremed/estimator/cost/doppler.hpp"
#include "cremed/estimator/cost/exclusive_likelihood.hpp"
#include "cremed/estimator/cost/mixture.hpp"
#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/cost/shared_doppler.hpp"
#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/scan/pose2.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// How a registration ended.
enum class RegistrationStatus : std::uint8_t {
  converged,       ///< Step below step_tolerance, or no step lowers the cost.
  degenerate,      ///< The information is not positive definite: the targets do not fix all states.
  ambiguous,       ///< Too few targets found again, too many possible partners for a
                   ///< target, or another motion fits nearly as well.
  no_convergence,  ///< A limit on iterations or component evaluations cut in before the end.
  non_finite,      ///< The cost is not a number: the input was out of any range.
};

/// The ego-motion between two scans: pose of the vehicle at the current scan in its frame at the
/// previous scan, order (x_m, y_m, yaw_rad).
struct RegistrationResult {
  RegistrationStatus status = RegistrationStatus::non_finite;
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< y row and column 0 in 2 DoF.
  /// What the two scans say about all three states, whatever the degrees of freedom: the cost near
  /// `motion` is g' d + d' H d / 2. Without the errors that no measurement shows.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  /// Normalised innovation squared, a degree of freedom, of the motion by the positions against
  /// that by the Doppler alone: 1 on average. NaN if one of them does not fix it, or with
  /// gauss_newton.
  double doppler_innovation = std::numeric_limits<double>::quiet_NaN();
  double cost = 0.0;     ///< Negative log likelihood + constant of the covariance model.
  double matched = 0.0;  ///< Expected number of targets found again; 0 with gauss_newton.
  int iterations = 0;    ///< Gauss-Newton steps of both stages, of all starts.
  int starts = 1;        ///< Searches made; more than one if the first fitted badly.
  std::int64_t component_evaluations = 0;

  /// Whether `motion` is the end of a search, maybe one that a limit cut short.
  [[nodiscard]] bool has_motion() const {
    return status == RegistrationStatus::converged || status == RegistrationStatus::no_convergence;
  }
};

/// Max-Sum-Mixture registration of two scans with Doppler (RA-L 2022), Gauss-Newton with step
/// halving, in two stages: wide standard deviations, then the true ones. With
/// CovarianceModel::exclusive the second stage climbs the likelihood of one-to-one assignments
/// instead, and if few targets are found again the search is repeated from other yaw angles. All
/// storage is inside the object: solving never allocates.
///
///     Registration registration(options, vehicle_from_radar);
///     registration.set_previous(previous_targets);
///     const RegistrationResult result = registration.solve(current_targets, dt_s);
class Registration {
 public:
  /// The first stage ends at a step shorter than this, squared, in standard deviations. It only has
  /// to end near enough for the second, which is less to ask of it where the second climbs the
  /// exclusive likelihood.
  static constexpr double kStartStepTolerance = 1e-2;
  static constexpr double kExclusiveStartStepTolerance = 0.1;

  Registration(const RegistrationOptions& options, const Pose2& vehicle_from_radar);

  /// The scan that the motion starts at; must hold at least one target.
  void set_previous(const TargetSet& targets);

  /// The motion to the current scan, `dt_s` later; starts at zero as the paper does.
  RegistrationResult solve(const TargetSet& current, double dt_s);

  /// The same, started where the cost of the first stage is lowest among `starts` (not empty).
  RegistrationResult solve(const TargetSet& current, double dt_s,
                           std::span<const Eigen::Vector3d> starts);

  /// Cost and normal equations of the Max-Sum-Mixture at a given motion, with true standard
  /// deviations (scale 1) or those of the first stage.
  NormalEquations linearise(const TargetSet& current, double dt_s, const Eigen::Vector3d& motion,
                            double scale, double doppler_scale);

 private:
  struct Stage {
    double scale;
    double doppler_scale;
    int max_iterations;
    double step_tolerance;
  };
  /// The current scan.
  struct Problem {
    const TargetSet& current;
    double dt_s;
  };

  RegistrationResult search(const Problem& problem, std::span<const Eigen::Vector3d> starts);
  RegistrationResult search_again(const Problem& problem, const Eigen::Vector3d& start,
                                  const RegistrationResult& first);
  /// The equations at the best of the starts, which goes to `result.motion`.
  NormalEquations begin(const Problem& problem, const Stage& stage,
                        std::span<const Eigen::Vector3d> starts, RegistrationResult& result);
  /// Gauss-Newton on the mixture from result.motion, where `equations` are given, until the end.
  RegistrationStatus run_stage(const Problem& problem, const Stage& stage,
                               RegistrationResult& result, NormalEquations& equations);
  void finish_gauss_newton(const Problem& problem, const Stage& stage, RegistrationResult& result,
                           NormalEquations& equations);
  void finish_exclusive(const Problem& problem, RegistrationResult& result);
  /// Ascends the exclusive likelihood from result.motion.
  RegistrationStatus climb(const Problem& problem, RegistrationResult& result,
                           NormalEquations& equations);
  NormalEquations linearise_exclusive(const Problem& problem, const Eigen::Vector3d& motion,
                                      bool settle);
  void add_doppler(const Problem& problem, const Eigen::Vector3d& motion, double scale,
                   NormalEquations& equations) const;
  void keep_equations(const Problem& problem, const NormalEquations& equations,
                      RegistrationResult& result);
  void add_unseen_errors(const Problem& problem, RegistrationResult& result) const;
  [[nodiscard]] double matched_share(const Problem& problem,
                                     const RegistrationResult& result) const;
  [[nodiscard]] std::int64_t evaluations() const;
  [[nodiscard]] bool is_spent() const;

  RegistrationOptions options_;
  Pose2 vehicle_from_radar_;
  OutlierRay ray_;
  Mixture mixture_;
  ExclusiveLikelihood likelihood_;
  SharedDoppler shared_doppler_;
  TargetSet previous_;
  bool is_previous_finite_ = false;
  std::int64_t mixture_evaluations_ = 0;  // of the current solve
  // Scratch of linearise(), of each current target.
  std::array<Eigen::Vector2d, kMaxDetections> lever_m_;  // R(yaw) m_i
  std::array<MixturePoint, kMaxDetections> points_;
  std::array<MixtureResidual, kMaxDetections> residuals_;
};

}  // namespace cremed
