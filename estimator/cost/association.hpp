// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

#include "cremed/can_decoders/radar_scan.hpp"

namespace cremed {

/// Probabilities p_ij of pairs of a target i of the current scan ("row") and a target j of the
/// previous scan ("column"), if each target has at most one partner in the other scan. psi_ij is
/// the likelihood of the pair over the likelihood that both have no partner. The sum over all such
/// assignments is approximated by the minimum of a free energy over p_ij, (4) of the README:
///
///     sum_ij p_ij log(p_ij / psi_ij) + 1/2 sum_i p_i0 log p_i0 + 1/2 sum_j p_0j log p_0j
///
/// where p_i0 = 1 - sum_j p_ij and p_0j = 1 - sum_i p_ij are the probabilities of having no
/// partner. It is convex, and exact for a pair without competitors and for a block of equal ratios
/// far from 1. It is solved by scaling rows and columns in turn (Sinkhorn; with slack: Gold et al.,
/// "New algorithms for 2D and 3D point matching", Pattern Recognition 1998):
///
///     p_ij = psi_ij f_i h_j,   p_i0 = f_i^2,   p_0j = h_j^2,
///     f_i = 2 / (Z_i + sqrt(Z_i^2 + 4)) with Z_i = sum_j psi_ij h_j, and h_j likewise; (5).
///
/// (Belief propagation, the usual method, gives the better of two assignments a probability of 1 if
/// two targets compete for two.) All storage is inside the object.
class Association {
 public:
  /// 16 partners for each of 256 targets.
  static constexpr std::size_t kMaxPairs = 4096;
  /// A pair with this ratio is certain: 1 - p = 1e-12, which a double resolves to four digits.
  static constexpr double kMaxRatio = 1e12;
  /// Bounds the work on clusters. Their probabilities may then still be off by about kTolerance.
  static constexpr int kMaxRounds = 32;
  /// Rounds before over-relaxation (factor 1.5 in the logarithm). They suffice unless a part of a
  /// cluster is hidden, where scaling converges slowly.
  static constexpr int kPlainRounds = 4;
  /// Scaling ends when no column's probability of having a partner changes by more than this: 0.2 %
  /// of a target's weight.
  static constexpr double kTolerance = 2e-3;
  /// The same for the gradients of log f, log h, in units of the states.
  static constexpr double kGradientTolerance = 1e-2;

  /// Removes all pairs and sets the number of columns (<= kMaxDetections). Factors are kept.
  void clear(std::size_t columns);
  /// Begins the next row (<= kMaxDetections in all), to which pairs are added from now on.
  void begin_row();
  /// Adds a pair with its psi and g = -d log psi / d state. false: full, the pair is left out.
  bool add(std::size_t column, double ratio, const Eigen::Vector3d& gradient);

  /// Replaces the psi of a pair.
  void set_ratio(std::size_t k, double ratio) { ratio_[k] = std::min(ratio, kMaxRatio); }

  /// Sets the factors to start values that do not depend on earlier ones.
  void start();
  /// Computes the probabilities, starting from the present factors; returns the number of rounds.
  /// With fewer rounds or a larger tolerance the next call continues.
  int solve(int max_rounds = kMaxRounds, double tolerance = kTolerance);
  /// Whether the last call converged to kTolerance or used kMaxRounds.
  [[nodiscard]] bool is_solved() const { return is_solved_; }
  /// The minimum of (4), an approximation of -log of the sum over all assignments.
  [[nodiscard]] double cost() const;
  /// The missing information -sum_ij g_ij (d p_ij / d state)' at the last solution, the minimum of
  /// (7) of the README. With a = d log f, b = d log h,
  ///
  ///     (sum_j p_ij + 2 p_i0) a_i + sum_j p_ij b_j = sum_j p_ij g_ij, and so for columns,
  ///     missing = sum_ij p_ij g_ij (g_ij - a_i - b_j)'
  ///
  /// is positive semi-definite. If rounds end early it is too large, never too small. `unit`: the
  /// unit of each state for kGradientTolerance.
  Eigen::Matrix3d missing_information(const Eigen::Vector3d& unit);

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// The pairs of row i are those from row_begin(i) to before row_begin(i + 1).
  [[nodiscard]] std::size_t row_begin(std::size_t i) const { return row_begin_[i]; }
  [[nodiscard]] std::size_t column(std::size_t k) const { return column_of_[k]; }
  [[nodiscard]] double probability(std::size_t k) const { return probability_[k]; }
  [[nodiscard]] const Eigen::Vector3d& gradient(std::size_t k) const { return gradient_[k]; }

 private:
  using Factors = std::array<double, kMaxDetections>;
  using Gradients = std::array<Eigen::Vector3d, kMaxDetections>;

  double scale(bool over_relaxed);
  void scale_row_gradients();
  double scale_column_gradients(const Eigen::Vector3d& unit);

  // Not initialised: most elements are never used.
  std::array<double, kMaxPairs> ratio_;
  std::array<double, kMaxPairs> probability_;
  std::array<std::uint16_t, kMaxPairs> row_of_;
  std::array<std::uint16_t, kMaxPairs> column_of_;
  std::array<Eigen::Vector3d, kMaxPairs> gradient_;
  std::array<std::uint16_t, kMaxDetections + 1> row_begin_;
  std::size_t size_ = 0;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  bool is_solved_ = false;
  Factors row_factor_;     // f
  Factors column_factor_;  // h
  Factors row_sum_;        // scratch, like the next two
  Factors sum_;
  Factors change_;
  Gradients row_gradient_;     // a
  Gradients column_gradient_;  // b
  Gradients column_sum_;
};

// Inline: it is called for every pair in every step.
inline bool Association::add(std::size_t column, double ratio, const Eigen::Vector3d& gradient) {
  if (size_ == kMaxPairs) {
    return false;
  }
  row_of_[size_] = static_cast<std::uint16_t>(rows_ - 1);
  column_of_[size_] = static_cast<std::uint16_t>(column);
  ratio_[size_] = std::min(ratio, kMaxRatio);
  // One by one: see Symmetric2::quadratic.
  gradient_[size_].x() = gradient.x();
  gradient_[size_].y() = gradient.y();
  gradient_[size_].z() = gradient.z();
  ++size_;
  row_begin_[rows_] = static_cast<std::uint16_t>(size_);
  return true;
}

}  // namespace cremed
