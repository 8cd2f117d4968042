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

/// Likelihood of a motion x if each target has at most one partner in the other scan. A mixture
/// asks each current target on its own where it may come from: one previous target then serves
/// several current ones, which counts its noise as if it were drawn anew each time, and pulls the
/// estimate to the nearest neighbours. Here all one-to-one assignments A are summed up instead:
///
///     L(x) = sum_A prod_(i,j) in A psi_ij(x)
///     psi_ij = P / (1 - P)  N(r_i - mu_j; C_ij) / lambda_i,   P = min((1 - w_o) n / F, 0.95)
///     lambda_i = n sum_k w_k N(m_i - ray_k; S_ray,k + S_i)
///
/// with r_i, mu_j, C_ij as in the mixture, n current and F previous targets, P the probability that
/// a previous target is seen again, and lambda_i the density of targets that were not seen before,
/// which the outlier ray gives in the current scan's own frame. With p_ij of Association and
/// g_ij = J_i' C_ij^-1 e_ij:
///
///     gradient of -log L       sum p_ij g_ij
///     complete information     sum p_ij J_i' C_ij^-1 J_i               (assignment known; EM step)
///     missing information      -sum g_ij (d p_ij / d x)'                (Louis, JRSS B 1982)
///
/// Complete less missing information is the curvature of -log L: the assignment is marginalised. As
/// in the mixture, covariances are held fixed in derivatives. All storage is
/// inside the object.
class ExclusiveLikelihood {
 public:
  /// Two scans, none of them empty.
  void assign(const TargetSet& previous, const TargetSet& current, const OutlierRay& ray);

  /// A list holds the pairs that may come to matter while targets move by so many standard
  /// deviations.
  static constexpr double kListReach = 1.0;

  /// Lists the pairs that can matter near `motion`. false: more than there is room for; the pairs
  /// of the last targets are then missing.
  bool list_pairs(const TargetSet& previous, const TargetSet& current,
                  const Eigen::Vector3d& motion);

  /// Probabilities of the pairs, gradient, complete information and cost (-log L) at a motion. On
  /// the way (`settle` false) the association goes on from the last motion's for a few rounds only.
  NormalEquations linearise(const TargetSet& previous, const TargetSet& current,
                            const Eigen::Vector3d& motion, bool settle = true);
  /// Whether the last ones are as exact as they get.
  [[nodiscard]] bool is_settled() const { return association_.is_solved(); }

  /// The missing information, at the last linearisation.
  [[nodiscard]] Eigen::Matrix3d missing_information(const Eigen::Vector3d& sigma) {
    return association_.missing_information(sigma);
  }

  /// Expected number of targets that have a partner, at the last linearisation.
  [[nodiscard]] double matched() const { return matched_; }
  /// Work done since assign(): component evaluations, pairs and messages.
  [[nodiscard]] std::int64_t evaluations() const { return evaluations_; }

 private:
  using Row = std::array<double, kMaxDetections>;
  using Candidates = std::array<std::uint16_t, Association::kMaxPairs>;

  /// A pair at the last linearisation.
  struct Term {
    double xx, xy, yy;           // C_ij^-1
    Eigen::Vector2d pull_per_m;  // C_ij^-1 e_ij
  };

  bool list_row(std::size_t i, const TargetSet& previous, const Target& moved);
  void add_pair(std::size_t i, std::size_t j, const Target& previous, const Target& moved,
                const Eigen::Vector2d& lever_m);
  [[nodiscard]] NormalEquations sum_up();

  // Not set to zero: most are never touched.
  Association association_;
  std::array<Term, Association::kMaxPairs> terms_;
  // Previous targets that may be partners, of each current target from candidate_begin_[i].
  Candidates candidates_;
  std::array<std::size_t, kMaxDetections + 1> candidate_begin_;
  bool is_new_ = true;  // the candidates were listed since the last linearisation
  // Of each current target:
  std::array<Eigen::Vector2d, kMaxDetections> lever_m_;  // R(yaw) m_i
  Row ratio_scale_m2_;                                   // psi_ij / N(r_i - mu_j; C_ij)
  Row max_squared_distance_;                             // beyond it psi_ij < kMinRatio
  // Of each previous target:
  alignas(64) Row x_m_;
  alignas(64) Row y_m_;
  alignas(64) Row variance_m2_;  // trace of the covariance
  alignas(64) Row excess_m2_;    // scratch of list_row
  double matched_ = 0.0;
  std::int64_t evaluations_ = 0;
};

}  // namespace cremed
