// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "cremed/can_decoders/radar_scan.hpp"
#include "cremed/estimator/cost/mixture_cost.hpp"
#include "cremed/estimator/registration/registration_options.hpp"
#include "cremed/estimator/scan/target_set.hpp"

namespace cremed::simulation {

using Random = std::mt19937_64;
using Points = std::vector<Eigen::Vector2d>;
using Detections = std::vector<Detection>;

/// Period of a radar.
inline constexpr double kPeriodS = 0.075;
/// Times in s between the two scans of a pair.
inline constexpr double kDt = 0.2;
inline constexpr double kShortDt = 0.1;

inline constexpr Pose2 kFront{3.4, 0.0, 0.0};
inline constexpr Pose2 kRearLeft{-0.6, 0.6, 3.05};
inline constexpr Pose2 kRearRight{-0.6, -0.6, -3.05};
/// One ahead and one to the left, in which nothing is zero.
inline const std::vector<Pose2> kTwoMounts{{3.4, 0.1, 0.02}, {2.4, 0.8, 1.54}};

inline constexpr std::array kModels = {Likelihood::exclusive, Likelihood::max_sum_mixture};
inline const Eigen::Vector3d kStill = Eigen::Vector3d::Zero();

struct Noise {
  double range_m = 0.13;
  double azimuth_rad = 0.0157;
  double doppler_mps = 0.3;
};

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Point of the frame in which `pose` = (x, y, yaw) is given, as seen from that pose.
inline Eigen::Vector2d seen_from(const Eigen::Vector3d& pose, const Eigen::Vector2d& point) {
  return Eigen::Rotation2Dd(-pose.z()) * (point - pose.head<2>());
}

inline Eigen::Vector3d as_vector(const Pose2& pose) { return {pose.x_m, pose.y_m, pose.yaw_rad}; }

/// The inverse of a motion.
inline Eigen::Vector3d inverse(const Eigen::Vector3d& motion) {
  const Eigen::Vector2d origin = seen_from(motion, Eigen::Vector2d::Zero());
  return {origin.x(), origin.y(), -motion.z()};
}

/// Detection of a static point of the vehicle frame by an ideal radar, while the vehicle moves with
/// `velocity` = (m/s forward, m/s left, rad/s) in its own frame.
inline Detection observe(const Eigen::Vector2d& point, const Eigen::Vector3d& velocity,
                         const Pose2& mount, const Noise& noise) {
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

/// All points as seen after `motion`, of duration `dt_s` at constant speed.
inline Detections observe_all(const Points& points, const Eigen::Vector3d& motion, double dt_s,
                              const Pose2& mount, const Noise& noise) {
  Detections detections;
  for (const Eigen::Vector2d& point : points) {
    detections.push_back(observe(seen_from(motion, point), motion / dt_s, mount, noise));
  }
  return detections;
}

/// All points as seen after `motion` by a radar at the vehicle's origin.
inline Detections see(const Points& points, const Eigen::Vector3d& motion) {
  return observe_all(points, motion, kDt, {}, {});
}

/// With isotropic noise: covariances then do not depend on yaw.
inline Detections isotropic(Detections detections, double std_m) {
  for (Detection& detection : detections) {
    detection.range_std_m = std_m;
    detection.azimuth_std_rad = std_m / detection.range_m;
  }
  return detections;
}

/// Adds noise with the detection's standard deviations.
inline void perturb(Detections& detections, Random& random) {
  std::normal_distribution<double> normal;
  for (Detection& detection : detections) {
    detection.range_m += detection.range_std_m * normal(random);
    detection.azimuth_rad += detection.azimuth_std_rad * normal(random);
    detection.doppler_mps += detection.doppler_std_mps * normal(random);
  }
}

inline TargetSet targets(const Detections& detections, const Pose2& mount) {
  TargetSet set;
  for (const Detection& detection : detections) {
    set.add(detection, mount);
  }
  return set;
}

inline RadarScan scan(const Detections& detections, std::int64_t stamp_us) {
  RadarScan result;
  result.stamp_us = stamp_us;
  for (const Detection& detection : detections) {
    result.detections.at(result.count++) = detection;
  }
  result.announced = result.count;
  return result;
}

/// Points around the vehicle, at least `spacing_m` apart, as a radar with the given field of view
/// at the vehicle's origin sees them.
inline Points scatter(Random& random, std::size_t count, double min_range_m, double max_range_m,
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

/// No systematic errors: the noise of targets is independent.
inline SharedErrorOptions no_shared_errors() { return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}; }

/// Settings with which the paper's simulated problem is solved (Doppler of the current scan, 2
/// DoF).
inline RegistrationOptions paper_options() {
  RegistrationOptions options;
  options.start_scale = 6.0;
  options.start_doppler_scale = 1.0;
  options.outlier_ray.weight = 0.2;
  options.doppler.stamp_std_s = 0.0;
  options.doppler.both_scans = false;
  options.shared_errors = no_shared_errors();
  return options;
}

inline RegistrationOptions paper_options(int degrees_of_freedom, bool has_doppler,
                                         Likelihood model = Likelihood::exclusive) {
  RegistrationOptions options = paper_options();
  options.likelihood = model;
  options.degrees_of_freedom = degrees_of_freedom;
  options.doppler.enabled = has_doppler;
  return options;
}

/// The paper's cost of two scans, with the standard deviations of the current scan times `scale`.
inline std::unique_ptr<MixtureCost> mixture_cost(const RegistrationOptions& options,
                                                 const Pose2& mount, const TargetSet& previous,
                                                 const TargetSet& current, double dt_s,
                                                 double scale = 1.0) {
  auto cost = std::make_unique<MixtureCost>(options.degrees_of_freedom, options.doppler, mount);
  cost->set_previous(previous, OutlierRay(options.outlier_ray, mount));
  cost->set_current(current, dt_s);
  cost->set_scales(scale, scale);
  return cost;
}

}  // namespace cremed::simulation
