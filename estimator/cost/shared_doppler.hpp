// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "cremed/estimator/cost/cost_options.hpp"
#include "cremed/estimator/cost/doppler.hpp"
#include "cremed/estimator/cost/normal_equations.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed {

/// 0 when the vehicle stands, 1 when it drives: the part of a driving vehicle's errors that shows.
/// A distance up to its noise is none.
double rolling_part(const Eigen::Vector3d& motion, double noise_m, double dt_s);

/// The Doppler of both scans, with the errors that their targets share as nuisance parameters, each
/// with a Gaussian prior around zero (SharedErrorOptions):
///
///     e_i = u_i(c) - v_i dt + dt b + du_i/dphi d +- dt^2/2 (du_i/dx a + du_i/dy l + du_i/dyaw w)
///
/// with the residual u_i - v_i dt of DopplerResidual, the offset b of all Doppler of the radar, the
/// error d of its mounting yaw, and the accelerations a and l along x and y and w of the yaw:
/// Doppler tells the velocity when a scan is taken (+ current, - previous scan), in the vehicle's
/// frame of that moment. The mean of both is what the vehicle makes of the motion m half way
/// through the turn: c = (R(-yaw/2) (x, y), yaw), but in 2 DoF, where it never moves sideways,
/// c = m and l = 0.
///
/// The shared errors s = (b, d, a, l, w) are eliminated (Schur complement), which leaves the
/// equations of m alone:
///
///     H = H_mm - H_ms (H_ss + P^-1)^-1 H_sm       g = g_m - H_ms (H_ss + P^-1)^-1 g_s
///
/// As e_i is linear in s, its value matters for one thing only: which targets count as moving.
/// NormalEquations::shared is s - (H_ss + P^-1)^-1 g_s, the best for this m.
///
/// b and d are errors of a vehicle that drives: their deviations are those of SharedErrorOptions
/// times rolling_part(m), the noise of m by Doppler taken alone.
class SharedDoppler {
 public:
  SharedDoppler(int degrees_of_freedom, const DopplerOptions& doppler,
                const SharedErrorOptions& errors, const Pose2& vehicle_from_radar);

  [[nodiscard]] NormalEquations linearise(const TargetSet& previous, const TargetSet& current,
                                          double dt_s, const Unknowns& at) const;

 private:
  static constexpr int kShared = SharedErrors::RowsAtCompileTime;
  using SharedMatrix = Eigen::Matrix<double, kShared, kShared>;

  /// Normal equations of motion and shared errors together.
  struct Sums {
    NormalEquations motion;
    Eigen::Matrix<double, 3, kShared> cross = Eigen::Matrix<double, 3, kShared>::Zero();
    SharedMatrix shared = SharedMatrix::Zero();
    SharedErrors gradient = SharedErrors::Zero();
  };
  /// `side`: 1 for the current scan, -1 for the previous.
  void add_scan(const TargetSet& targets, const Unknowns& half_way, double dt_s, double side,
                Sums& sums) const;
  /// P^-1, which is diagonal.
  [[nodiscard]] SharedErrors prior_information(double rolling) const;

  int degrees_of_freedom_;
  DopplerOptions options_;
  SharedErrorOptions errors_;
  Pose2 vehicle_from_radar_;
};

}  // namespace cremed
