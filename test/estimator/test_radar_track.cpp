// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <random>
#include <vector>

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/radar_track.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using simulation::Random;

TEST_CASE("the noise of Doppler is that of its residuals, whatever is configured") {
  const double true_std_mps = GENERATE(0.08, 0.13, 0.4);
  const double configured_std_mps = GENERATE(0.03, 0.13, 1.0);
  CAPTURE(true_std_mps, configured_std_mps);
  constexpr int kScans = 400;
  constexpr int kLearning = 20;
  const Pose2 mount{3.4, 0.0, 0.0};
  const Eigen::Vector3d motion(8.0, 0.0, 0.0);
  Random random(3);
  std::normal_distribution<double> normal;
  const OdometryOptions options;
  RadarTrack track(options);
  double nis = 0.0;
  for (int i = 0; i < kScans; ++i) {
    simulation::Detections detections;
    for (const auto& point : simulation::scatter(random, 60, 5.0, 60.0, 1.0, 0.5)) {
      detections.push_back(
          simulation::observe(point, motion, mount, {0.1, 0.005, configured_std_mps}));
      detections.back().doppler_mps += true_std_mps * normal(random);
    }
    const auto scan = track.velocity(simulation::targets(detections, mount), std::nullopt);
    REQUIRE(scan);
    if (i >= kLearning) {
      const Eigen::Vector2d error = scan->velocity.velocity_mps - motion.head<2>();
      nis += 0.5 * error.dot(scan->velocity.covariance_in_traffic().inverse() * error);
    }
  }
  nis /= kScans - kLearning;
  CHECK(nis > 0.8);
  CHECK(nis < 1.25);
}

/// The results of `count` scans of 60 static targets and as many others as `moving` has, which
/// drive by with nearly their Doppler.
std::vector<DopplerVelocity> pass_traffic(RadarTrack& track, std::size_t moving, int count) {
  const Pose2 mount{3.4, 0.0, 0.0};
  const Eigen::Vector3d still(3.0, 0.0, 0.45);
  const Eigen::Vector3d along(2.6, -0.9, 0.45);
  Random random(5);
  std::vector<DopplerVelocity> velocities;
  for (int i = 0; i < count; ++i) {
    simulation::Detections detections;
    for (const auto& point : simulation::scatter(random, 60, 5.0, 60.0, 1.0, 0.5)) {
      detections.push_back(simulation::observe(point, still, mount, {0.1, 0.005, 0.1}));
    }
    for (const auto& point : simulation::scatter(random, moving, 5.0, 60.0, 1.0, 0.5)) {
      detections.push_back(simulation::observe(point, along, mount, {0.1, 0.005, 0.1}));
    }
    const auto scan =
        track.velocity(simulation::targets(detections, mount), Eigen::Vector2d(3.0, 1.53));
    velocities.push_back(scan.value().velocity);
  }
  return velocities;
}

TEST_CASE("targets that move nearly alike do not pass for noise, nor unnoticed") {
  const OdometryOptions options;
  RadarTrack track(options);
  const DopplerVelocity before = pass_traffic(track, 0, 50).back();
  const std::vector<DopplerVelocity> beside = pass_traffic(track, 40, 30);
  CHECK(beside.back().targets < 80);  // Of 100.
  for (const DopplerVelocity& velocity : beside) {
    const Eigen::Vector2d error = velocity.velocity_mps - Eigen::Vector2d(3.0, 1.53);
    CHECK(error.dot(velocity.covariance_in_traffic().inverse() * error) < 25.0);
  }
  CHECK(beside.back().covariance_in_traffic()(1, 1) > 4.0 * before.covariance_in_traffic()(1, 1));
  const DopplerVelocity after = pass_traffic(track, 0, 10).back();
  CHECK(after.covariance_in_traffic()(1, 1) < 1.5 * before.covariance_in_traffic()(1, 1));
}

}  // namespace
}  // namespace cremed
