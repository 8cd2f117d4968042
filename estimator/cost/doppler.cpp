// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/doppler.hpp"

#include <cmath>

namespace cremed {

namespace {

/// One Gaussian of the max mixture. Its cost is -log(weight N) up to a constant.
struct Component {
  double variance_m2;
  double weight;

  [[nodiscard]] double cost(double squared_error_m2) const {
    return 0.5 * (squared_error_m2 / variance_m2 + std::log(variance_m2 / (weight * weight)));
  }
};

/// Whether the first component is clearly the better one. Sufficient test without a logarithm.
bool is_clear(const Component& first, const Component& second, double squared_error_m2) {
  constexpr double kSquaredError = 8.0;
  constexpr double kRatio = 2981.0;  // exp(8)
  return squared_error_m2 <= kSquaredError * first.variance_m2 &&
         first.weight * first.weight * second.variance_m2 >=
             kRatio * second.weight * second.weight * first.variance_m2;
}

}  // namespace

DopplerGeometry::DopplerGeometry(const Target& target, const Eigen::Vector3d& motion,
                                 const Pose2& vehicle_from_radar) {
  const double c = target.cos_bearing;
  const double s = target.sin_bearing;
  const double sensor_x_m = motion.x() - motion.z() * vehicle_from_radar.y_m;
  const double sensor_y_m = motion.y() + motion.z() * vehicle_from_radar.x_m;
  range_change_m = -sensor_x_m * c - sensor_y_m * s;
  per_bearing_m = sensor_x_m * s - sensor_y_m * c;
  jacobian << -c, -s, vehicle_from_radar.y_m * c - vehicle_from_radar.x_m * s;
}

DopplerResidual doppler_residual(const Target& target, const DopplerGeometry& geometry, double dt_s,
                                 const DopplerOptions& options, double scale, double shared_m) {
  DopplerResidual result;
  result.error_m = geometry.range_change_m - target.doppler_mps * dt_s + shared_m;
  const double squared_error_m2 = result.error_m * result.error_m;

  const double stamp_m = target.doppler_mps * options.stamp_std_s;
  const double bearing_m = geometry.per_bearing_m * target.bearing_std_rad;
  const double common_m2 = stamp_m * stamp_m + bearing_m * bearing_m;
  const auto component = [&](double weight, double doppler_std_mps) {
    const double doppler_m = dt_s * doppler_std_mps;
    return Component{doppler_m * doppler_m + common_m2, weight};
  };

  Component best = component(1.0 - options.moving_weight, target.doppler_std_mps * scale);
  result.cost = best.cost(squared_error_m2);
  const Component moving = component(options.moving_weight, options.moving_std_mps);
  if (options.moving_weight > 0.0 && !is_clear(best, moving, squared_error_m2)) {
    const double moving_cost = moving.cost(squared_error_m2);
    if (moving_cost < result.cost) {
      result.cost = moving_cost;
      result.is_static = false;
      best = moving;
    }
  }
  result.per_m = 1.0 / std::sqrt(best.variance_m2);
  return result;
}

}  // namespace cremed
