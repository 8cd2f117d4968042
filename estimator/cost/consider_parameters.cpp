// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/consider_parameters.hpp"

#include <cmath>

#include "cremed/estimator/cost/doppler_rounding.hpp"
#include "cremed/estimator/cost/driving_share.hpp"
#include "cremed/estimator/scan/squared.hpp"

namespace cremed {
namespace {

/// Jerk over one standard deviation of acceleration: 10 m/s^3 for 3 m/s^2, as in hard braking.
/// Doppler of both scans measures the change of velocity, but not when it happens. The distance
/// then errs by up to jerk dt^3 / 12: 0.4 mm from scan to scan, 53 mm over a gap of 0.4 s.
constexpr double kJerkPerAcceleration = 10.0 / 3.0;

}  // namespace

void add_consider_covariance(const SharedErrorOptions& errors, const Eigen::Vector3d& motion,
                             double dt_s, bool by_doppler, int degrees_of_freedom,
                             Eigen::Matrix3d& covariance) {
  if (by_doppler) {
    const Eigen::Vector2d by_scale_m = errors.doppler_scale_std * motion.head<2>();
    covariance.topLeftCorner<2, 2>() += by_scale_m * by_scale_m.transpose();
  }
  const double noise_m = std::sqrt(covariance(0, 0));
  const double speed_mps = speed_beyond_noise_mps(motion, noise_m, dt_s);
  const double by_velocity_m = driving_share(speed_mps) * errors.velocity_std_mps * dt_s;
  const double by_rounding_m =
      by_doppler ? rounding_share(speed_mps) * errors.rounding_std_mps * dt_s : 0.0;
  const double by_jerk_m =
      by_doppler ? kJerkPerAcceleration * errors.acceleration_std_mps2 * std::pow(dt_s, 3) / 12.0
                 : 0.0;
  const double variance_m2 = squared(by_velocity_m) + squared(by_rounding_m) + squared(by_jerk_m);
  covariance(0, 0) += variance_m2;
  covariance(1, 1) += degrees_of_freedom == 3 ? variance_m2 : 0.0;
}

}  // namespace cremed
