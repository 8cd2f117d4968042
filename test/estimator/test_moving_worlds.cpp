// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Most targets of a single radar move: no wrong motion has status ok.

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/motion_witness.hpp"
#include "cremed/estimator/fusion/odometry_filter.hpp"
#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "test/estimator/odometry_drive.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using namespace simulation;

constexpr std::int64_t kPeriodUs = 75'000;
constexpr double kFarM = 80.0;
const Noise kWorldNoise{0.1, 0.008, 0.1};

/// Objects in a box in front of the radar, rigid relative to each other. Those of the road repeat
/// at its end.
struct World {
  Points points;
  double speed_mps = 0.0;

  void pass(double vehicle_mps) {
    for (Eigen::Vector2d& point : points) {
      point.x() += (speed_mps - vehicle_mps) * kPeriodS;
      if (speed_mps == 0.0) {
        point.x() += point.x() < 0.0 ? kFarM : 0.0;
      }
    }
  }
};

World world(Random& random, std::size_t count, Eigen::Vector2d from, Eigen::Vector2d to) {
  World result;
  for (std::size_t i = 0; i < count; ++i) {
    result.points.emplace_back(uniform(random, from.x(), to.x()),
                               uniform(random, from.y(), to.y()));
  }
  return result;
}

/// A vehicle that drives straight on, its radar, and the estimates.
class Stage {
 public:
  explicit Stage(std::uint64_t seed) : random_(seed) {
    options_.vehicle_from_radar = kFront;
    estimator_ = std::make_unique<EgoMotionEstimator>(options_);
    filter_ = std::make_unique<OdometryFilter>(OdometryOptions(), std::vector{kFront});
  }

  Random& random() { return random_; }

  void next(std::vector<World*> worlds, double vehicle_mps) {
    stamp_us_ += kPeriodUs;
    Detections detections;
    for (World* world : worlds) {
      world->pass(vehicle_mps);
      for (const Eigen::Vector2d& point : world->points) {
        detections.push_back(
            observe(point, {vehicle_mps - world->speed_mps, 0.0, 0.0}, kFront, kWorldNoise));
      }
    }
    perturb(detections, random_);
    RadarScan scan;
    scan.stamp_us = stamp_us_;
    scan.status = ScanStatus::complete;
    scan.count = static_cast<std::uint16_t>(detections.size());
    std::copy(detections.begin(), detections.end(), scan.detections.begin());
    take(scan, vehicle_mps);
  }

  int published = 0;
  int wrong = 0;
  int standing = 0;
  OdometryStatus last = OdometryStatus::initialising;

 private:
  void take(const RadarScan& scan, double vehicle_mps) {
    const EgoMotion motion = estimator_->update(scan);
    if (motion.has_estimate() && !contradicts(odometry_, motion)) {
      note(motion.motion.x() / kPeriodS, std::sqrt(motion.covariance(0, 0)) / kPeriodS, vehicle_mps,
           motion.status == MotionStatus::standing_still);
    }
    odometry_ = filter_->update(0, estimator_->targets(), scan.stamp_us);
    last = odometry_.status;
    if (odometry_.is_usable()) {
      note(odometry_.twist.x(), std::sqrt(odometry_.twist_covariance(0, 0)), vehicle_mps,
           odometry_.status == OdometryStatus::standing_still);
    }
  }

  void note(double speed_mps, double std_mps, double true_mps, bool stands) {
    ++published;
    wrong += std::abs(speed_mps - true_mps) > 5.0 * std_mps ? 1 : 0;
    standing += stands ? 1 : 0;
  }

  Random random_;
  EgoMotionOptions options_;
  std::unique_ptr<EgoMotionEstimator> estimator_;
  std::unique_ptr<OdometryFilter> filter_;
  Odometry odometry_;
  std::int64_t stamp_us_ = 1'000'000'000;
};

World road(Stage& stage, std::size_t count) {
  return world(stage.random(), count, {8.0, -15.0}, {kFarM, 15.0});
}

/// The rear of a truck and its sides.
World truck(Stage& stage, double speed_mps) {
  World result = world(stage.random(), 30, {15.0, -1.3}, {24.0, 1.3});
  result.speed_mps = speed_mps;
  return result;
}

TEST_CASE("Behind a truck from the start, with four static objects, there is no standstill") {
  const auto seed = GENERATE(1U, 2U, 3U, 4U, 5U);
  Stage stage(seed);
  World standing = road(stage, 4);
  World ahead = truck(stage, 8.0);
  for (int i = 0; i < 270; ++i) {
    stage.next({&standing, &ahead}, 8.0);
  }
  CHECK(stage.standing == 0);
  CHECK(stage.wrong == 0);
}

TEST_CASE("A truck that cuts in causes no standstill, and after it the road is used again") {
  const auto seed = GENERATE(1U, 2U, 3U, 4U, 5U);
  Stage stage(seed);
  World open = road(stage, 60);
  for (int i = 0; i < 40; ++i) {
    stage.next({&open}, 8.0);
  }
  CHECK(stage.last == OdometryStatus::ok);
  const int before = stage.published;
  World few = road(stage, 4);
  World ahead = truck(stage, 8.0);
  for (int i = 0; i < 80; ++i) {
    stage.next({&few, &ahead}, 8.0);
  }
  CHECK(stage.standing == 0);
  CHECK(stage.wrong * 1000 <= stage.published);
  World again = road(stage, 60);
  for (int i = 0; i < 40; ++i) {
    stage.next({&again}, 8.0);
  }
  CHECK(stage.last == OdometryStatus::ok);
  CHECK(stage.published >= before + 40);
  CHECK(stage.wrong * 1000 <= stage.published);
}

TEST_CASE("A train that starts alongside causes no motion backwards") {
  const auto seed = GENERATE(1U, 2U, 3U, 4U, 5U);
  Stage stage(seed);
  World platform = road(stage, 30);
  World train = world(stage.random(), 60, {6.0, 3.0}, {50.0, 6.0});
  for (int i = 0; i < 40; ++i) {
    stage.next({&platform, &train}, 0.0);
  }
  CHECK(stage.last == OdometryStatus::standing_still);
  // Until its Doppler differs from the platform's by more than noise (0.1 m/s each), both look like
  // one world that moves slowly.
  while (train.speed_mps < 0.6) {
    train.speed_mps += 0.8 * kPeriodS;
    stage.next({&platform, &train}, 0.0);
  }
  CHECK(stage.wrong <= 10);
  const int before = stage.wrong;
  for (int i = 0; i < 80; ++i) {
    train.speed_mps += 0.8 * kPeriodS;
    stage.next({&platform, &train}, 0.0);
  }
  CHECK(stage.wrong == before);
}

TEST_CASE("In a jam whose cars hide the road for some seconds there is no standstill") {
  const auto seed = GENERATE(1U, 2U, 3U, 4U, 5U);
  Stage stage(seed);
  World standing = road(stage, 12);
  World cars = world(stage.random(), 60, {6.0, -6.0}, {50.0, 6.0});
  for (int i = 0; i < 40; ++i) {
    stage.next({&standing, &cars}, 0.0);
  }
  CHECK(stage.last == OdometryStatus::standing_still);
  while (cars.speed_mps < 4.0) {
    cars.speed_mps += 1.0 * kPeriodS;
    stage.next({&standing, &cars}, cars.speed_mps);
  }
  CHECK(stage.last == OdometryStatus::ambiguous);
  for (int i = 0; i < 50; ++i) {
    stage.next({&cars}, cars.speed_mps);
    CHECK(stage.last != OdometryStatus::ok);
    CHECK(stage.last != OdometryStatus::standing_still);
  }
  // All stand, and the road shows again.
  cars.speed_mps = 0.0;
  for (int i = 0; i < 100; ++i) {
    stage.next({&standing, &cars}, 0.0);
  }
  CHECK(stage.last == OdometryStatus::standing_still);
}

TEST_CASE("A rival speed that is no continuation does not make a radar ambiguous") {
  Stage stage(1);
  World open = road(stage, 60);
  for (int i = 0; i < 40; ++i) {
    stage.next({&open}, 16.0);
  }
  const int before = stage.published;
  // Continuous oncoming traffic.
  World oncoming = world(stage.random(), 25, {10.0, 4.0}, {70.0, 8.0});
  for (int i = 0; i < 100; ++i) {
    oncoming.speed_mps = -14.0;
    stage.next({&open, &oncoming}, 16.0);
    for (Eigen::Vector2d& point : oncoming.points) {
      point.x() += point.x() < 5.0 ? 65.0 : 0.0;
    }
  }
  CHECK(stage.published >= before + 190);
  CHECK(stage.wrong == 0);
}

}  // namespace
}  // namespace cremed
