// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/cost/doppler.hpp"
#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// The Doppler of both scans. The systematic errors of all targets are nuisance parameters with
/// zero-mean Gaussian priors (SharedErrorOptions):
///
///     e_i = u_i(c) - v_i dt + dt b + du_i/dphi d +- dt^2/2 (du_i/dx a + du_i/dy l + du_i/dyaw w)
///
/// with the residual u_i - v_i dt of DopplerResidual, the offset b of all Doppler of the radar, the
/// error d of its mounting yaw, and the accelerations a along x, l along y and w of the yaw.
/// Doppler measures the velocity at its scan (+ current, - previous scan), in the vehicle frame at
/// that time. The mean of both velocities is that of the motion m in the frame half way through the
/// turn: c = (R(-yaw/2) (x, y), yaw). In 2 DoF there is no sideways motion: c = m and l = 0.
///
/// The shared errors s = (b, d, a, l, w) are marginalised (Schur complement), which leaves the
/// equations of m; (8) of the README:
///
///     H = H_mm - H_ms (H_ss + P^-1)^-1 H_sm       g = g_m - H_ms (H_ss + P^-1)^-1 g_s
///
/// As e_i is linear in s, its value only affects which targets count as moving.
/// NormalEquations::shared is s - (H_ss + P^-1)^-1 g_s, the best s for this m.
///
/// b and d vanish at rest: their standard deviations in SharedErrorOptions are multiplied by
/// driving_share of the speed beyond the noise of m by Doppler alone.
class SharedDoppler {
 public:
  SharedDoppler(int degrees_of_freedom, const DopplerOptions& doppler,
                const SharedErrorOptions& errors, const Pose2& vehicle_from_radar);

  [[nodiscard]] NormalEquations linearise(const TargetSet& previous, const TargetSet& current,
                                          double dt_s, const Unknowns& at) const;

 private:
  static constexpr int kShared = SharedErrors::RowsAtCompileTime;
  using SharedMatrix = Eigen::Matrix<double, kShared, kShared>;

  /// Joint normal equations of motion and shared errors.
  struct Sums {
    Eigen::Matrix<double, 3 + kShared, 3 + kShared> information =
        Eigen::Matrix<double, 3 + kShared, 3 + kShared>::Zero();
    Eigen::Matrix<double, 3 + kShared, 1> gradient = Eigen::Matrix<double, 3 + kShared, 1>::Zero();
    double cost = 0.0;
  };
  /// `side`: 1 for the current scan, -1 for the previous.
  void add_scan(const TargetSet& targets, const Unknowns& half_way, double dt_s, double side,
                Sums& sums) const;
  /// P^-1, which is diagonal.
  [[nodiscard]] SharedErrors prior_information(double driving) const;

  int degrees_of_freedom_;
  DopplerOptions options_;
  SharedErrorOptions errors_;
  Pose2 vehicle_from_radar_;
};

}  // namespace cremed
