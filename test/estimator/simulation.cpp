// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/simulation.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "cremed/estimator/cost/outlier_ray.hpp"

namespace cremed::simulation {

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Eigen::Vector2d seen_from(const Eigen::Vector3d& pose, const Eigen::Vector2d& point) {
  return Eigen::Rotation2Dd(-pose.z()) * (point - pose.head<2>());
}

Eigen::Vector3d as_vector(const Pose2& pose) { return {pose.x_m, pose.y_m, pose.yaw_rad}; }

Eigen::Vector3d inverse(const Eigen::Vector3d& motion) {
  const Eigen::Vector2d origin = seen_from(motion, Eigen::Vector2d::Zero());
  return {origin.x(), origin.y(), -motion.z()};
}

Detection observe(const Eigen::Vector2d& point, const Eigen::Vector3d& velocity, const Pose2& mount,
                  const Noise& noise) {
  const Eigen::Vector2d local = seen_from(as_vector(mount), point);
  const Eigen::Vector2d line_of_sight = (point - as_vector(mount).head<2>()).normalized();
  const Eigen::Vector2d sensor_velocity(velocity.x() - velocity.z() * mount.y_m,
                                        velocity.y() + velocity.z() * mount.x_m);
  Detection detection;
  detection.range_m = local.norm();
  detection.azimuth_rad = std::atan2(local.y(), local.x());
  detection.doppler_mps = -sensor_velocity.dot(line_of_sight);
  detection.range_std_m = noise.range_m;
  detection.azimuth_std_rad = noise.azimuth_rad;
  detection.doppler_std_mps = noise.doppler_mps;
  detection.validity = Validity::usable;
  return detection;
}

Detections observe_all(const Points& points, const Eigen::Vector3d& motion, double dt_s,
                       const Pose2& mount, const Noise& noise) {
  Detections detections;
  for (const Eigen::Vector2d& point : points) {
    detections.push_back(observe(seen_from(motion, point), motion / dt_s, mount, noise));
  }
  return detections;
}

Detections see(const Points& points, const Eigen::Vector3d& motion) {
  return observe_all(points, motion, kDt, {}, {});
}

Detections isotropic(Detections detections, double std_m) {
  for (Detection& detection : detections) {
    detection.range_std_m = std_m;
    detection.azimuth_std_rad = std_m / detection.range_m;
  }
  return detections;
}

void perturb(Detections& detections, Random& random) {
  std::normal_distribution<double> normal;
  for (Detection& detection : detections) {
    detection.range_m += detection.range_std_m * normal(random);
    detection.azimuth_rad += detection.azimuth_std_rad * normal(random);
    detection.doppler_mps += detection.doppler_std_mps * normal(random);
  }
}

TargetSet targets(const Detections& detections, const Pose2& mount) {
  TargetSet set;
  for (const Detection& detection : detections) {
    set.add(detection, mount);
  }
  return set;
}

RadarScan scan(const Detections& detections, std::int64_t stamp_us) {
  RadarScan result;
  result.stamp_us = stamp_us;
  for (const Detection& detection : detections) {
    result.detections.at(result.count++) = detection;
  }
  result.announced = result.count;
  return result;
}

Points scatter(Random& random, std::size_t count, double min_range_m, double max_range_m,
               double half_view_rad, double spacing_m) {
  Points points;
  while (points.size() < count) {
    const double range_m = uniform(random, min_range_m, max_range_m);
    const double azimuth_rad = uniform(random, -half_view_rad, half_view_rad);
    const Eigen::Vector2d point(range_m * std::cos(azimuth_rad), range_m * std::sin(azimuth_rad));
    bool is_free = true;
    for (const Eigen::Vector2d& other : points) {
      is_free = is_free && (point - other).norm() >= spacing_m;
    }
    if (is_free) {
      points.push_back(point);
    }
  }
  return points;
}

SharedErrorOptions no_shared_errors() { return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }

RegistrationOptions paper_options() {
  RegistrationOptions options;
  options.start_scale = 6.0;
  options.start_doppler_scale = 1.0;
  options.outlier_ray.weight = 0.2;
  options.doppler.stamp_std_s = 0.0;
  options.doppler.both_scans = false;
  options.shared_errors = no_shared_errors();
  return options;
}

RegistrationOptions paper_options(int degrees_of_freedom, bool has_doppler, Likelihood model) {
  RegistrationOptions options = paper_options();
  options.likelihood = model;
  options.degrees_of_freedom = degrees_of_freedom;
  options.doppler.enabled = has_doppler;
  return options;
}

std::unique_ptr<MixtureCost> mixture_cost(const RegistrationOptions& options, const Pose2& mount,
                                          const TargetSet& previous, const TargetSet& current,
                                          double dt_s, double scale) {
  auto cost = std::make_unique<MixtureCost>(options.degrees_of_freedom, options.doppler, mount);
  cost->set_previous(previous, OutlierRay(options.outlier_ray, mount));
  cost->set_current(current, dt_s);
  cost->set_scales(scale, scale);
  return cost;
}

}  // namespace cremed::simulation
