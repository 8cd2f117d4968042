// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/estimator/cost/association.hpp"
#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/cost/outlier_ray.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Likelihood of a motion x if each target has at most one partner in the other scan. In a mixture
/// one previous target may explain several current ones: its noise then counts as drawn anew each
/// time, and the estimate is biased towards the nearest neighbours. Here all one-to-one assignments
/// A are summed instead, (3) of the README:
///
///     L(x) = sum_A prod_(i,j) in A psi_ij(x)
///     psi_ij = P_d / (1 - P_d)  N(r_i - mu_j; C_ij) / lambda_i,   P_d = min((1 - w_o) n / F, 0.95)
///     lambda_i = n sum_k w_k N(m_i - ray_k; S_ray,k + S_i)
///
/// with r_i, mu_j, C_ij as in the mixture, n current and F previous targets, P_d the probability
/// that a previous target is seen again, and lambda_i the density of new targets, given by the
/// outlier ray in the current scan's frame. With p_ij of Association and g_ij = J_i' C_ij^-1 e_ij,
/// (6) of the README:
///
///     gradient of -log L       sum p_ij g_ij
///     complete information     sum p_ij J_i' C_ij^-1 J_i               (assignment known; EM step)
///     missing information      -sum g_ij (d p_ij / d x)'                (Louis, JRSS B 1982)
///
/// Complete minus missing information is the curvature of -log L, with the assignment marginalised.
/// Covariances are held fixed in derivatives. All storage is inside the object.
class ExclusiveLikelihood {
 public:
  /// Two scans, none of them empty.
  void assign(const TargetSet& previous, const TargetSet& current, const OutlierRay& ray);

  /// A list stays valid while targets move by up to this many standard deviations.
  static constexpr double kListMarginSigmas = 1.0;

  /// Lists the pairs with a psi of at least 1e-3 near `motion`. false: more pairs than the
  /// capacity; pairs of the last targets are then missing.
  bool list_pairs(const TargetSet& previous, const TargetSet& current,
                  const Eigen::Vector3d& motion);

  /// Probabilities of the pairs, gradient, complete information and cost (-log L) at a motion. With
  /// `settle` false the association runs a few rounds only, from the solution at the last motion.
  NormalEquations linearise(const TargetSet& previous, const TargetSet& current,
                            const Eigen::Vector3d& motion, bool settle = true);
  /// Whether the association of the last linearisation has converged.
  [[nodiscard]] bool is_settled() const { return association_.is_solved(); }

  /// The missing information at the last linearisation. `sigma`: see Association.
  [[nodiscard]] Eigen::Matrix3d missing_information(const Eigen::Vector3d& sigma) {
    return association_.missing_information(sigma);
  }

  /// Expected number of targets that have a partner, at the last linearisation.
  [[nodiscard]] double matched() const { return matched_; }
  /// Work since assign(), in evaluations of a mixture component.
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }

 private:
  using Row = std::array<double, kMaxDetections>;
  using Candidates = std::array<std::uint16_t, Association::kMaxPairs>;

  /// A pair at the last linearisation.
  struct Term {
    Symmetric2 information;   // C_ij^-1
    double x_per_m, y_per_m;  // C_ij^-1 e_ij
    double greatest_ratio;    // psi_ij at e_ij = 0
  };

  void sort(const TargetSet& previous);
  bool list_row(std::size_t i, const TargetSet& previous, const Target& moved);
  void add_pair(std::size_t i, std::size_t j, const Target& previous, const Target& moved,
                const Eigen::Vector2d& lever_m);
  void set_ratios();
  [[nodiscard]] NormalEquations sum_up();

  // Not initialised: most elements are never used.
  Association association_;
  std::array<Term, Association::kMaxPairs> terms_;
  std::array<double, Association::kMaxPairs> exponents_;  // of psi_ij / greatest_ratio
  // Possible partners of each current target i, from candidate_begin_[i] on.
  Candidates candidates_;
  std::array<std::size_t, kMaxDetections + 1> candidate_begin_;
  bool is_new_ = true;  // candidates were listed after the last linearisation
  // Of each current target:
  std::array<Eigen::Vector2d, kMaxDetections> lever_m_;  // R(yaw) m_i
  Row ratio_scale_m2_;                                   // psi_ij / N(r_i - mu_j; C_ij)
  Row max_squared_distance_;                             // beyond it psi_ij < kMinRatio
  // Of each previous target, sorted by x:
  std::array<std::uint16_t, kMaxDetections> sorted_;  // its index
  Row x_m_;
  Row y_m_;
  Row variance_m2_;  // trace of the covariance
  double max_variance_x_m2_ = 0.0;
  Row excess_m2_;  // scratch of list_row, like the next
  std::array<std::uint16_t, kMaxDetections> near_;
  double matched_ = 0.0;
  std::int64_t evaluations_ = 0;
};

}  // namespace cremed
