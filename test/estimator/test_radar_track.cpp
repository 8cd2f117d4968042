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

using simulation::kFront;
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

/// The vehicle's motion, and that of traffic which differs by no more than the first weights allow.
const Eigen::Vector3d kStaticWorld(3.0, 0.0, 0.45);
const Eigen::Vector3d kSlower(2.0, 0.0, 0.45);
const Eigen::Vector3d kFaster(4.0, 0.0, 0.45);
const Eigen::Vector2d kVelocityOfFront(3.0, 3.4 * 0.45);

/// The results of `count` scans of 60 static targets and 20 more for each of `others`.
std::vector<DopplerVelocity> drive_beside(RadarTrack& track,
                                          const std::vector<Eigen::Vector3d>& others, int count) {
  Random random(5);
  std::normal_distribution<double> noise_mps(0.0, 0.12);
  std::vector<DopplerVelocity> velocities;
  for (int i = 0; i < count; ++i) {
    simulation::Detections detections;
    const auto observe = [&](std::size_t targets, const Eigen::Vector3d& motion) {
      for (const auto& point : simulation::scatter(random, targets, 5.0, 60.0, 1.0, 0.5)) {
        detections.push_back(simulation::observe(point, motion, kFront, {0.1, 0.005, 0.1}));
        detections.back().doppler_mps += noise_mps(random);
      }
    };
    observe(60, kStaticWorld);
    for (const Eigen::Vector3d& other : others) {
      observe(20, other);
    }
    const auto scan = track.velocity(simulation::targets(detections, kFront), kVelocityOfFront);
    velocities.push_back(scan.value().velocity);
  }
  return velocities;
}

TEST_CASE("targets that move nearly alike do not pass unnoticed") {
  const OdometryOptions options;
  RadarTrack track(options);
  const DopplerVelocity before = drive_beside(track, {}, 50).back();
  const std::vector<DopplerVelocity> beside = drive_beside(track, {kSlower, kSlower}, 30);
  CHECK(beside.back().targets < 80);  // Of 100.
  for (const DopplerVelocity& velocity : beside) {
    const Eigen::Vector2d error = velocity.velocity_mps - kVelocityOfFront;
    CHECK(error.dot(velocity.covariance_in_traffic().inverse() * error) < 25.0);
  }
  CHECK(beside.back().covariance_in_traffic()(1, 1) > 4.0 * before.covariance_in_traffic()(1, 1));
  const DopplerVelocity after = drive_beside(track, {}, 10).back();
  CHECK(after.covariance_in_traffic()(1, 1) < 1.5 * before.covariance_in_traffic()(1, 1));
}

TEST_CASE("traffic is not learned as noise of Doppler") {
  const OdometryOptions options;
  RadarTrack track(options);
  const DopplerVelocity before = drive_beside(track, {}, 50).back();
  drive_beside(track, {kSlower, kSlower, kFaster, kFaster}, 30);
  CHECK(drive_beside(track, {}, 1).back().covariance(1, 1) < 1.5 * before.covariance(1, 1));
}

}  // namespace
}  // namespace cremed
