// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <random>

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
      nis += 0.5 * error.dot(scan->velocity.covariance.inverse() * error);
    }
  }
  nis /= kScans - kLearning;
  CHECK(nis > 0.8);
  CHECK(nis < 1.25);
}

}  // namespace
}  // namespace cremed
