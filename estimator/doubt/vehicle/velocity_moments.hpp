// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace cremed {

/// Second moments of velocities e that a radar is expected to measure and m that it does, both
/// in the axes of the vehicle: with them e is compared with any linear function of m.
class VelocityMoments {
 public:
  /// Errors that the radar may have besides, standard deviations.
  struct Errors {
    double scale = 0.0;       ///< Of Doppler.
    double yaw_rad = 0.0;     ///< Of the mount,
    double x_m = 0.0;         ///< and of its place.
    double offset_mps = 0.0;  ///< Of the velocity in the direction of view.
  };
  /// The errors that fit best, and what then remains.
  struct Fit {
    double chi_square = 0.0;
    double scale = 0.0;
    double yaw_rad = 0.0;     ///< Of m: to be added to the mount's.
    double x_m = 0.0;         ///< Likewise,
    double offset_mps = 0.0;  ///< and this to m.
  };

  /// `weight`: of an error along the vehicle and across it, 1 / variance.
  void add(const Eigen::Vector2d& expected, const Eigen::Vector2d& measured, double yaw_rate_radps,
           const Eigen::Vector2d& weight);
  /// Multiplies what was added by this.
  void fade(double factor);
  /// Number of velocities, faded.
  [[nodiscard]] double count() const { return count_; }
  /// Compares e with `of_measured` m of a radar that looks into this direction.
  [[nodiscard]] Fit fit(const Eigen::Matrix2d& of_measured, double view_rad,
                        const Errors& errors) const;

 private:
  using Moments = Eigen::Matrix<double, 5, 5>;
  Moments along_ = Moments::Zero();   // Of (e_x, m_x, m_y, 0, 1),
  Moments across_ = Moments::Zero();  // and of (e_y, m_x, m_y, yaw rate, 1).
  double count_ = 0.0;
};

}  // namespace cremed
