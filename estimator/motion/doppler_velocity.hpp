// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// Standard deviation of one target's Doppler. Source: ARS408 on real drives (nuScenes 0061, 0103).
inline constexpr double kArs408DopplerStdMps = 0.13;

/// The sensor's velocity over ground from the Doppler of one scan, in the axes of the vehicle.
struct DopplerVelocity {
  Eigen::Vector2d velocity_mps = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< By the noise of the static targets.
  /// Difference to a fit with wider weights: the shift by targets that move with nearly the Doppler
  /// of static ones.
  Eigen::Vector2d difference_mps = Eigen::Vector2d::Zero();
  /// Derivative of the velocity by an offset of all Doppler.
  Eigen::Vector2d per_offset = Eigen::Vector2d::Zero();
  double residual_std_mps = 0.0;  ///< Of the static targets, by their median.
  int targets = 0;                ///< Number of static targets.

  /// Covariance with the shift by such targets, part of which is in `velocity_mps`.
  [[nodiscard]] Eigen::Matrix2d covariance_in_traffic() const;
};

/// Robust least squares of a static world's Doppler (Kellner et al., ITSC 2013; here all targets
/// with Tukey's weights W instead of a random choice of inliers):
///
///     doppler_i = -cos(phi_i) V_x - sin(phi_i) V_y + offset,   V = (A'WA)^-1 A'W doppler
///
/// While weights are computed the offset is an unknown (prior 0.2 m/s), so that it makes no target
/// an outlier. It is not in the result; its effect there is per_offset = (A'WA)^-1 A'W 1.
class DopplerVelocityEstimator {
 public:
  /// The velocity on which the targets agree whose Doppler differs from `start` by less than 2.3
  /// m/s, where the first weights become zero; none if they are too few or in one direction.
  /// `std_mps`: standard deviation of a target's Doppler.
  std::optional<DopplerVelocity> fit(const TargetSet& targets, const Eigen::Vector2d& start,
                                     double std_mps);
  /// The velocity that explains most targets, roughly: a start for fit(). Zero for an empty set.
  static Eigen::Vector2d search(const TargetSet& targets);

 private:
  double median_residual(const TargetSet& targets, const Eigen::Vector3d& solution,
                         double max_residual_mps);

  std::array<double, kMaxDetections> scratch_;
};

}  // namespace cremed
