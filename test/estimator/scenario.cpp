// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/estimator/scenario.hpp"

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "cremed/estimator/registration/registration.hpp"

namespace cremed::simulation {

void keep_visible(Detections& detections, double half_view_rad) {
  std::erase_if(detections, [&](const Detection& detection) {
    return std::abs(detection.azimuth_rad) > half_view_rad || detection.range_m <= 0.0;
  });
}

void add_clutter(Detections& detections, const Scenario& scenario, Random& random) {
  const double ratio = scenario.clutter / (1.0 - scenario.clutter);
  const auto count = std::lround(ratio * static_cast<double>(detections.size()));
  for (const Eigen::Vector2d& point :
       scatter(random, static_cast<std::size_t>(count), scenario.min_range_m, scenario.max_range_m,
               scenario.half_view_rad, 0.0)) {
    Detection detection = observe(point, Eigen::Vector3d::Zero(), {}, scenario.noise);
    detection.doppler_mps = uniform(random, -30.0, 30.0);
    detections.push_back(detection);
  }
}

void move_landmarks(Detections& current, double share, Random& random) {
  const auto count = static_cast<std::size_t>(share * static_cast<double>(current.size()));
  for (std::size_t i = 0; i < count; ++i) {
    const double speed_mps = uniform(random, 2.0, 20.0);
    current[i].doppler_mps += speed_mps;
    current[i].range_m += speed_mps * kDt;
  }
}

Points landmarks(const Scenario& scenario, Random& random) {
  Points points = scatter(random, 20, scenario.min_range_m, scenario.max_range_m,
                          scenario.half_spread_rad, 0.0);
  std::normal_distribution<double> beside_m(0.0, 0.1);
  for (std::size_t i = 0; i < 2 * scenario.clusters; ++i) {
    const double x_m = beside_m(random);
    points.emplace_back(points[i / 2] + Eigen::Vector2d(x_m, beside_m(random)));
  }
  return points;
}

RegistrationResult solve(const RegistrationOptions& options, const Detections& previous,
                         const Detections& current, double dt_s, const Pose2& mount) {
  const auto registration = std::make_unique<Registration>(options, mount);
  registration->set_previous(targets(previous, mount));
  return registration->solve(targets(current, mount), dt_s);
}

Run run(const Scenario& scenario, Random& random) {
  const bool is_car = scenario.options.degrees_of_freedom == 2;
  const Points points = landmarks(scenario, random);
  const Eigen::Vector3d motion{uniform(random, -0.25, 0.25),
                               is_car ? 0.0 : uniform(random, -0.25, 0.25),
                               uniform(random, -scenario.max_yaw_rad, scenario.max_yaw_rad)};
  Detections previous = observe_all(points, Eigen::Vector3d::Zero(), kDt, {}, scenario.noise);
  Detections current = observe_all(points, motion, kDt, {}, scenario.noise);
  move_landmarks(current, scenario.movers, random);
  for (Detections* detections : {&previous, &current}) {
    perturb(*detections, random);
    keep_visible(*detections, scenario.half_view_rad);
    add_clutter(*detections, scenario, random);
  }
  const RegistrationResult result = solve(scenario.options, previous, current);
  return {result.motion - motion, result};
}

Scenario without_doppler() {
  Scenario scenario;
  scenario.options.doppler.enabled = false;
  return scenario;
}

Scenario point_set() {
  Scenario scenario = without_doppler();
  scenario.options.degrees_of_freedom = 3;
  scenario.options.start_scale = 1.0;
  scenario.options.outlier_ray.weight = 0.0;
  scenario.noise = {0.2, radians(3.0), 0.3};
  scenario.min_range_m = 5.0;
  scenario.max_range_m = 15.0;
  scenario.half_spread_rad = radians(180.0);
  scenario.half_view_rad = radians(360.0);
  return scenario;
}

}  // namespace cremed::simulation
