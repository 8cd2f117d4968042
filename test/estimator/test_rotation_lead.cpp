// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/scan/rotation_lead.hpp"
#include "cremed/estimator/scan/target_set.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Random;
using simulation::uniform;

constexpr double kLeadS = 0.04;
constexpr double kGridMps = 0.25;

/// Motion of the sensor in its own frame.
struct SensorMotion {
  Eigen::Vector2d velocity_mps;
  double yaw_rate_radps;
};

Eigen::Vector2d direction(double azimuth_rad) {
  return {std::cos(azimuth_rad), std::sin(azimuth_rad)};
}

/// A static target as reported by an ARS408 that receives its motion: the whole relative velocity,
/// the extrapolated position.
Detection told_detection(const SensorMotion& motion, double range_m, double azimuth_rad,
                         double grid_mps) {
  const Eigen::Vector2d position = range_m * direction(azimuth_rad);
  Eigen::Vector2d velocity =
      -motion.velocity_mps - motion.yaw_rate_radps * Eigen::Vector2d(-position.y(), position.x());
  if (grid_mps > 0.0) {
    velocity = grid_mps * (velocity / grid_mps).array().round().matrix();
  }
  Detection detection;
  detection.validity = Validity::usable;
  detection.range_m = range_m;
  detection.azimuth_rad = azimuth_rad - motion.yaw_rate_radps * kLeadS;
  const Eigen::Vector2d sight = direction(detection.azimuth_rad);
  detection.doppler_mps = velocity.dot(sight);
  detection.across_mps = velocity.dot(Eigen::Vector2d(-sight.y(), sight.x()));
  detection.range_std_m = 0.2;
  detection.azimuth_std_rad = 0.01;
  detection.doppler_std_mps = 0.1;
  return detection;
}

RadarScan told_scan(Random& random, const SensorMotion& motion, int targets,
                    double grid_mps = kGridMps) {
  RadarScan scan;
  for (int i = 0; i < targets; ++i) {
    scan.detections[scan.count++] =
        told_detection(motion, uniform(random, 2.0, 70.0), uniform(random, -0.9, 0.9), grid_mps);
  }
  return scan;
}

/// Sensors that report no velocity across the line of sight give 0.
void forget_across(RadarScan& scan) {
  for (std::size_t i = 0; i < scan.count; ++i) {
    scan.detections[i].across_mps = 0.0;
  }
}

SensorMotion random_motion(Random& random) {
  return {{uniform(random, -5.0, 30.0), uniform(random, -1.0, 1.0)}, uniform(random, -0.6, 0.6)};
}

}  // namespace

TEST_CASE("The yaw rate a sensor is told shows in the velocities across the line of sight") {
  Random random(1);
  for (int run = 0; run < 200; ++run) {
    const SensorMotion motion = random_motion(random);
    const int targets = GENERATE(10, 40, 250);
    CAPTURE(run, targets, motion.yaw_rate_radps);
    const double error_radps =
        reported_yaw_rate_radps(told_scan(random, motion, targets)) - motion.yaw_rate_radps;
    // The grid leaves 0.07 m/s per target over a range spread of 20 m.
    CHECK(std::abs(error_radps) < 6.0 * 0.1 / (20.0 * std::sqrt(targets)));
  }
}

TEST_CASE("Targets that move by themselves do not change the yaw rate found") {
  Random random(2);
  const SensorMotion motion{{12.0, 0.2}, 0.3};
  RadarScan scan = told_scan(random, motion, 100);
  for (std::size_t i = 0; i < 20; ++i) {
    scan.detections[i].across_mps += uniform(random, 3.0, 15.0);
  }
  CHECK(reported_yaw_rate_radps(scan) == Approx(0.3).margin(0.01));
}

TEST_CASE("A sensor that is told nothing, or a scan that cannot tell, turns nothing") {
  Random random(3);
  RadarScan scan = told_scan(random, {{12.0, 0.2}, 0.3}, 100);
  forget_across(scan);
  CHECK(reported_yaw_rate_radps(scan) == 0.0);
  CHECK(reported_yaw_rate_radps(RadarScan{}) == 0.0);

  RadarScan single = told_scan(random, {{12.0, 0.2}, 0.3}, 1);
  CHECK(std::isfinite(reported_yaw_rate_radps(single)));
  RadarScan unusable = told_scan(random, {{12.0, 0.2}, 0.3}, 100);
  for (Detection& detection : unusable.detections) {
    detection.validity = Validity::invalid_state;
  }
  CHECK(reported_yaw_rate_radps(unusable) == 0.0);
}

TEST_CASE("Turned back, positions and Doppler are those of the stamp") {
  Random random(4);
  for (int run = 0; run < 100; ++run) {
    const SensorMotion motion = random_motion(random);
    const double range_m = uniform(random, 2.0, 100.0);
    const double azimuth_rad = uniform(random, -1.0, 1.0);
    const Detection reported = told_detection(motion, range_m, azimuth_rad, 0.0);
    const Detection at_stamp = turned(reported, motion.yaw_rate_radps * kLeadS);
    CHECK(at_stamp.azimuth_rad == Approx(azimuth_rad).margin(1e-12));
    CHECK(at_stamp.range_m == reported.range_m);
    CHECK(at_stamp.doppler_mps ==
          Approx(-motion.velocity_mps.dot(direction(azimuth_rad))).margin(1e-9));

    // Uncorrected, Doppler differs by tau w^2 r from the model at the reported line of sight.
    const double bias_mps =
        reported.doppler_mps + motion.velocity_mps.dot(direction(reported.azimuth_rad));
    const double squared = motion.yaw_rate_radps * motion.yaw_rate_radps;
    CHECK(bias_mps == Approx(kLeadS * squared * range_m).margin(2e-4 * squared * range_m));
  }
}

TEST_CASE("A target set is of the stamp's time, whether the sensor was told its motion or not") {
  Random random(5);
  const bool is_told = GENERATE(true, false);
  const double yaw_rate_radps = GENERATE(-0.5, -0.1, 0.0, 0.2, 0.5);
  CAPTURE(is_told, yaw_rate_radps);
  const SensorMotion motion{{8.0, 0.0}, yaw_rate_radps};
  RadarScan scan = told_scan(random, motion, 80);
  const double lead_s = is_told ? kLeadS : 0.0;
  if (!is_told) {
    for (std::size_t i = 0; i < scan.count; ++i) {
      scan.detections[i] = turned(scan.detections[i], yaw_rate_radps * kLeadS);
    }
    forget_across(scan);
  }
  TargetSet targets;
  SelectionCounters counters;
  targets.assign(scan, {}, {}, counters, {.rotation_lead_s = kLeadS});
  REQUIRE(targets.size() == scan.count);
  double bias_mps = 0.0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const double azimuth_rad = scan.detections[i].azimuth_rad + yaw_rate_radps * lead_s;
    CHECK(targets[i].bearing_rad == Approx(azimuth_rad).margin(0.01 * kLeadS));
    bias_mps += targets[i].doppler_mps + motion.velocity_mps.dot(direction(azimuth_rad));
  }
  // Of 80 roundings to 0.25 m/s.
  CHECK(std::abs(bias_mps / static_cast<double>(targets.size())) < 0.04);
}

TEST_CASE("A velocity that is not finite is not hidden") {
  RadarScan scan;
  scan.count = 1;
  scan.detections[0] = told_detection({{5.0, 0.0}, 0.1}, 10.0, 0.1, 0.0);
  scan.detections[0].across_mps = std::numeric_limits<double>::quiet_NaN();
  TargetSet targets;
  SelectionCounters counters;
  targets.assign(scan, {}, {}, counters, {.rotation_lead_s = kLeadS});
  CHECK_FALSE(targets.is_finite());
}

}  // namespace cremed
