// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cremed/estimator/cost/outlier_ray.hpp"

#include <cmath>

namespace cremed {

std::size_t ray_component_count(const OutlierRayOptions& options) {
  const double span =
      (1.0 - kRayRatio) / (1.0 + kRayRatio) * options.max_range_m / options.min_range_m;
  const double needed = 1.0 + std::ceil(std::log(span) / std::log(kRayGrowth));
  // fmax, unlike clamp, also replaces NaN, the logarithm of invalid options.
  return static_cast<std::size_t>(
      std::fmin(std::fmax(needed, 1.0), static_cast<double>(kMaxRayComponents)));
}

OutlierRay::OutlierRay(const OutlierRayOptions& options, const Pose2& vehicle_from_radar) {
  if (options.weight <= 0.0) {
    return;
  }
  size_ = ray_component_count(options);
  weight_ = options.weight;
  const double azimuth_std_rad = 1.5 * options.field_of_view_rad;
  double range_m = options.min_range_m / (1.0 - kRayRatio);
  double total_weight = 0.0;
  for (std::size_t k = 0; k < size_; ++k, range_m *= kRayGrowth) {
    const double range_std_m = 2.0 * kRayRatio * range_m;
    RayComponent& component = components_[k];
    component.x_m = vehicle_from_radar.x_m + range_m * std::cos(vehicle_from_radar.yaw_rad);
    component.y_m = vehicle_from_radar.y_m + range_m * std::sin(vehicle_from_radar.yaw_rad);
    component.covariance_m2 =
        polar_covariance(range_m, vehicle_from_radar.yaw_rad, range_std_m, azimuth_std_rad);
    // sqrt(det) of a polar covariance, so that the density is uniform along the ray.
    component.weight = range_std_m * range_m * azimuth_std_rad;
    total_weight += component.weight;
  }
  for (std::size_t k = 0; k < size_; ++k) {
    components_[k].weight *= options.weight / total_weight;
  }
}

}  // namespace cremed
