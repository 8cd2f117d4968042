// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/can_decoders/radar_scan.hpp"

namespace cremed {

/// Probabilities of pairs of a target of the current scan ("row") and one of the previous scan
/// ("column"), if a target has at most one partner in the other scan. psi_ij is a pair's likelihood
/// over that of both standing alone. Of the sum over all such assignments, entropy's approximation
/// is taken: the p_ij that minimise
///
///     sum_ij p_ij log(p_ij / psi_ij) + 1/2 sum_i p_i0 log p_i0 + 1/2 sum_j p_0j log p_0j
///
/// where p_i0 = 1 - sum_j p_ij and p_0j = 1 - sum_i p_ij are the probabilities of having none. It
/// is convex, exact for a pair without competitors, and for a block of equals whose ratios are far
/// from 1; it is solved by scaling
/// rows and columns in turn (Sinkhorn; with slack: Gold et al., "New algorithms for 2D and 3D point
/// matching", Pattern Recognition 1998):
///
///     p_ij = psi_ij u_i v_j,   p_i0 = u_i^2,   p_0j = v_j^2,
///     u_i = 2 / (S_i + sqrt(S_i^2 + 4)) with S_i = sum_j psi_ij v_j, and so v_j.
///
/// (Belief propagation, the usual way, takes the better of two assignments for certain where two
/// targets compete for two.) All storage is inside the object.
class Association {
 public:
  /// 16 partners for each of 256 targets.
  static constexpr std::size_t kMaxPairs = 4096;
  /// Bounds the work of clusters, where probabilities then are off by about kTolerance still.
  static constexpr int kMaxRounds = 32;
  /// Scaling converges slowly where some of a cluster are hidden: after so many rounds, which solve
  /// all other cases, it is over-relaxed (factor 1.5 in the logarithm).
  static constexpr int kPlainRounds = 4;
  /// Scaling ends when no column's probability of having a partner changes by more: 0.2 % of a
  /// target's weight.
  static constexpr double kTolerance = 2e-3;
  /// The same for the gradients of log u, log v, in units of the states.
  static constexpr double kGradientTolerance = 1e-2;

  /// Forgets all pairs; columns to come are below this number (<= kMaxDetections). Factors stay.
  void clear(std::size_t columns);
  /// The pairs that are added next belong to the next row (<= kMaxDetections in all).
  void begin_row();
  /// Adds a pair with its psi and g = -d log psi / d state. false: full, the pair is left out.
  bool add(std::size_t column, double ratio, const Eigen::Vector3d& gradient);

  /// Sets the factors without regard to earlier ones.
  void start();
  /// Computes the probabilities from the factors so far; returns the rounds it took. Where
  /// `max_rounds` were too few the next call goes on from there.
  int solve(int max_rounds = kMaxRounds);
  /// Whether the last call took all the rounds it needed, or kMaxRounds.
  [[nodiscard]] bool is_solved() const { return is_solved_; }
  /// Value of the minimum, an approximation of -log of the sum over all assignments.
  [[nodiscard]] double cost() const;
  /// -sum_ij g_ij (d p_ij / d state)' at the last solution. With a = d log u, b = d log v,
  ///
  ///     (sum_j p_ij + 2 p_i0) a_i + sum_j p_ij b_j = sum_j p_ij g_ij, and so for columns,
  ///     missing = sum_ij p_ij g_ij (g_ij - a_i - b_j)'
  ///
  /// is positive semidefinite; few rounds leave it too large, never too small. `unit`: what counts
  /// as a small change of each state.
  Eigen::Matrix3d missing_information(const Eigen::Vector3d& unit);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// The pairs of row i are those from row_begin(i) to before row_begin(i + 1).
  [[nodiscard]] std::size_t row_begin(std::size_t i) const { return row_begin_[i]; }
  [[nodiscard]] std::size_t column(std::size_t k) const { return column_of_[k]; }
  [[nodiscard]] double ratio(std::size_t k) const { return ratio_[k]; }
  [[nodiscard]] double probability(std::size_t k) const { return probability_[k]; }
  [[nodiscard]] const Eigen::Vector3d& gradient(std::size_t k) const { return gradient_[k]; }

 private:
  using Factors = std::array<double, kMaxDetections>;
  using Gradients = std::array<Eigen::Vector3d, kMaxDetections>;

  double scale(bool over_relaxed);
  void scale_row_gradients();
  double scale_column_gradients(const Eigen::Vector3d& unit);

  // Not set to zero: most are never touched.
  std::array<double, kMaxPairs> ratio_;
  std::array<double, kMaxPairs> probability_;
  std::array<std::uint16_t, kMaxPairs> column_of_;
  std::array<Eigen::Vector3d, kMaxPairs> gradient_;
  std::array<std::uint16_t, kMaxDetections + 1> row_begin_;
  std::size_t size_ = 0;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  bool is_solved_ = false;
  Factors row_factor_;     // u
  Factors column_factor_;  // v
  Factors row_sum_;        // scratch, as what follows
  Factors sum_;
  Factors change_;
  Gradients row_gradient_;     // a
  Gradients column_gradient_;  // b
  Gradients column_sum_;
};

}  // namespace cremed
