// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "estimator/doppler.hpp"
#include "estimator/normal_equations.hpp"
#include "estimator/registration_options.hpp"
#include "estimator/target_set.hpp"

namespace cremed {

/// The Doppler of both scans, with the errors that their targets share. Each of these is an unknown
/// of its own, known beforehand only to be small (SharedErrorOptions):
///
///     e_i = u_i(m) - v_i dt + dt b + du_i/dphi d +- dt^2/2 (du_i/dx a + du_i/dyaw w)
///
/// with the residual u_i - v_i dt of DopplerResidual, the offset b of all Doppler of the radar, the
/// error d of its mounting yaw, and the accelerations a and w along x and of the yaw: Doppler tells
/// the velocity when a scan is taken (+ current, - previous scan), while the motion m is the mean
/// of the time between. b, d, a, w are Gaussian around zero; for a given m their best values follow
/// from a linear equation, and eliminating them (Schur complement) leaves the equations of m alone:
///
///     H = H_mm - H_ms (H_ss + P^-1)^-1 H_sm       g = g_m - H_ms (H_ss + P^-1)^-1 g_s
class SharedDoppler {
 public:
  SharedDoppler(const DopplerOptions& options, const SharedErrorOptions& errors,
                const Pose2& vehicle_from_radar);

  /// Begins a registration: shared errors are unknown again. `rolling` (0..1) is the part of offset
  /// and mounting error that shows at the vehicle's speed.
  void start(double rolling);

  /// Adds to `equations` what the Doppler says about `motion`. Which targets move is told by the
  /// shared errors found at the call before.
  void add(const TargetSet& previous, const TargetSet& current, const Eigen::Vector3d& motion,
           double dt_s, NormalEquations& equations);

 private:
  static constexpr int kShared = 4;  // b, d, a, w
  using SharedVector = Eigen::Matrix<double, kShared, 1>;
  using SharedMatrix = Eigen::Matrix<double, kShared, kShared>;

  /// Normal equations of motion and shared errors together.
  struct Sums {
    NormalEquations motion;
    Eigen::Matrix<double, 3, kShared> cross = Eigen::Matrix<double, 3, kShared>::Zero();
    SharedMatrix shared = SharedMatrix::Zero();
    SharedVector gradient = SharedVector::Zero();
  };
  /// `side`: 1 for the current scan, -1 for the previous.
  void add_scan(const TargetSet& targets, const Eigen::Vector3d& motion, double dt_s, double side,
                Sums& sums) const;

  DopplerOptions options_;
  SharedErrorOptions errors_;
  Pose2 vehicle_from_radar_;
  SharedVector prior_information_ = SharedVector::Zero();  // P^-1, which is diagonal.
  SharedVector shared_ = SharedVector::Zero();
};

}  // namespace cremed
