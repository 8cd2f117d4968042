// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

#include "cremed/estimator/cost/yaw_by_positions.hpp"

namespace cremed {

/// How a registration ended. With the next step s, the information H of the free states, the
/// expected number m of matched targets, n current and F previous targets:
enum class RegistrationStatus : std::uint8_t {
  /// s' H s < kStepTolerance of the cost; or the cost is higher at s, s / 2, s / 4 .. s / 2048, and
  /// s' H s <= kMaxStuckSquaredStep.
  converged,
  /// 1 / cond(H) <= kMinReciprocalCondition, or H is not positive definite: not all free states are
  /// observable.
  degenerate,
  /// m < kMinMatchedShare min(n, F); or more than Association::kMaxPairs pairs; or a search from
  /// another yaw angle ended at a distance d with d' C^-1 d > kMinRivalSquaredDistance and a cost
  /// higher by less than kMaxRivalLogRatio.
  ambiguous,
  /// Steps >= max_iterations or component evaluations >= max_component_evaluations before the end;
  /// or the cost is higher at s .. s / 2048, and s' H s > kMaxStuckSquaredStep.
  no_convergence,
  /// A number of a target, or the cost, is NaN or infinite.
  non_finite,
};

/// The ego-motion between two scans: pose of the vehicle at the current scan in its frame at the
/// previous scan, order (x_m, y_m, yaw_rad).
struct RegistrationResult {
  RegistrationStatus status = RegistrationStatus::non_finite;
  Eigen::Vector3d motion = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< y row and column 0 in 2 DoF.
  /// Normalised innovation squared (NIS) per degree of freedom of the motion by positions alone
  /// against that by Doppler alone: 1 on average. NaN if one of them does not observe all free
  /// states, or with max_sum_mixture.
  double doppler_nis = std::numeric_limits<double>::quiet_NaN();
  YawByPositions by_positions;  ///< NaN with max_sum_mixture.
  double cost = 0.0;            ///< Negative log likelihood + constant of the likelihood.
  double matched = 0.0;         ///< Expected number of matched targets; 0 with max_sum_mixture.
  int iterations = 0;           ///< Gauss-Newton steps of both stages, of all starts.
  int starts = 1;               ///< Searches; more than one if the first matched few targets.
  std::int64_t component_evaluations = 0;

  /// Whether `motion` is the end of a search, possibly ended by a limit.
  [[nodiscard]] bool has_motion() const {
    return status == RegistrationStatus::converged || status == RegistrationStatus::no_convergence;
  }
};

}  // namespace cremed
