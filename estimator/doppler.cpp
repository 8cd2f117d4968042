// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/doppler.hpp"

#include <cmath>

namespace cremed {

DopplerResidual doppler_residual(const Target& target, const Eigen::Vector3d& motion,
                                 const Pose2& vehicle_from_radar, double dt_s,
                                 const DopplerOptions& options, double scale) {
  const double c = std::cos(target.bearing_rad);
  const double s = std::sin(target.bearing_rad);
  const double sensor_x_m = motion.x() - motion.z() * vehicle_from_radar.y_m;
  const double sensor_y_m = motion.y() + motion.z() * vehicle_from_radar.x_m;
  const double predicted_m = -sensor_x_m * c - sensor_y_m * s;
  const double error_m = predicted_m - target.doppler_mps * dt_s;

  const double stamp_m = target.doppler_mps * options.stamp_std_s;
  const double bearing_m = (sensor_x_m * s - sensor_y_m * c) * target.bearing_std_rad;
  const auto sigma = [&](double doppler_std_mps) {
    const double doppler_m = dt_s * doppler_std_mps;
    return std::sqrt(doppler_m * doppler_m + stamp_m * stamp_m + bearing_m * bearing_m);
  };
  const auto cost = [&](double weight, double sigma_m) {
    return 0.5 * error_m * error_m / (sigma_m * sigma_m) - std::log(weight / sigma_m);
  };

  DopplerResidual result;
  double sigma_m = sigma(target.doppler_std_mps * scale);
  result.cost = cost(1.0 - options.moving_weight, sigma_m);
  if (options.moving_weight > 0.0) {
    const double moving_sigma_m = sigma(options.moving_std_mps);
    const double moving_cost = cost(options.moving_weight, moving_sigma_m);
    if (moving_cost < result.cost) {
      result.cost = moving_cost;
      result.is_static = false;
      sigma_m = moving_sigma_m;
    }
  }
  result.residual = error_m / sigma_m;
  result.jacobian << -c, -s, vehicle_from_radar.y_m * c - vehicle_from_radar.x_m * s;
  result.jacobian /= sigma_m;
  return result;
}

}  // namespace cremed
