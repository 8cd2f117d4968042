// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

/// Second moments of the velocities e that a radar is expected to measure and m that it measures,
/// in the axes of the vehicle: enough to compare e with any linear function of m.
class VelocityMoments {
 public:
  /// Standard deviations of the errors that the radar may also have.
  struct Errors {
    double scale = 0.0;       ///< Of Doppler.
    double yaw_rad = 0.0;     ///< Of the mount.
    double x_m = 0.0;         ///< Of the mount.
    double offset_mps = 0.0;  ///< Of the velocity in the direction of view.
  };
  /// The errors that fit best, and the chi-square with them.
  struct Fit {
    double chi_square = 0.0;
    double scale = 0.0;
    double yaw_rad = 0.0;     ///< To be added to the yaw of the mount.
    double x_m = 0.0;         ///< To be added to the x of the mount.
    double offset_mps = 0.0;  ///< To be added to m, in the direction of view.
  };

  /// `weight`: of an error along the vehicle and across it, 1 / variance.
  void add(const Eigen::Vector2d& expected, const Eigen::Vector2d& measured, double yaw_rate_radps,
           const Eigen::Vector2d& weight);
  /// Multiplies the sums by this.
  void fade(double factor);
  /// Number of velocities, faded.
  [[nodiscard]] double count() const { return count_; }
  /// Compares e with `of_measured` m, for a radar that looks in the direction `view_rad`.
  [[nodiscard]] Fit fit(const Eigen::Matrix2d& of_measured, double view_rad,
                        const Errors& errors) const;

 private:
  using Moments = Eigen::Matrix<double, 5, 5>;
  Moments along_ = Moments::Zero();   // Of (e_x, m_x, m_y, 0, 1).
  Moments across_ = Moments::Zero();  // Of (e_y, m_x, m_y, yaw rate, 1).
  double count_ = 0.0;
};

}  // namespace cremed
