// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/parked_vehicle.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using namespace simulation;
using Verdict = ParkedVehicle::Verdict;

const Noise kParkedNoise{0.1, 0.008, 0.15};
const std::vector<Pose2> kFrontAndRear{{3.4, 0.0, 0.0}, {-0.9, 0.0, 3.14159}};

/// What one radar sees: targets around its axis, of which a share departs.
struct Sight {
  double share = 0.0;
  Eigen::Vector2d departing_mps = Eigen::Vector2d::Zero();
};

/// A parked vehicle with a radar at the front and one at the rear.
class Parked {
 public:
  explicit Parked(std::uint64_t seed) : random_(seed) {
    for (double time_s = 0.0; time_s < 1.5; time_s += kPeriodS) {
      Odometry standing;
      standing.utime_us = now_us_;
      standing.status = OdometryStatus::standing_still;
      vehicle.add_output(standing);
      see(0, {});
      see(1, {});
    }
  }

  /// By the next scan of a radar.
  Verdict see(std::size_t radar, const Sight& sight) {
    now_us_ += static_cast<std::int64_t>(0.5e6 * kPeriodS);
    TargetSet targets;
    Detections detections;
    for (int i = 0; i < 60; ++i) {
      const Pose2& mount = kFrontAndRear[radar];
      const double bearing_rad = mount.yaw_rad + uniform(random_, -0.9, 0.9);
      const double range_m = uniform(random_, 5.0, 40.0);
      const Eigen::Vector2d point(mount.x_m + range_m * std::cos(bearing_rad),
                                  mount.y_m + range_m * std::sin(bearing_rad));
      const bool departs = uniform(random_, 0.0, 1.0) < sight.share;
      const Eigen::Vector2d mps = departs ? sight.departing_mps : Eigen::Vector2d::Zero();
      detections.push_back(observe(point, {-mps.x(), -mps.y(), 0.0}, mount, kParkedNoise));
    }
    perturb(detections, random_);
    for (const Detection& detection : detections) {
      targets.add(detection, kFrontAndRear[radar]);
    }
    const auto velocity = fit_.fit(targets, DopplerVelocityEstimator::search(targets), 0.15);
    REQUIRE(velocity);
    return vehicle.judge(radar, targets, *velocity, now_us_);
  }

  /// Both radars, for `seconds`, at a velocity that increases from 0. Counts the verdicts.
  std::vector<int> accelerate(double share, Eigen::Vector2d mps2, double seconds) {
    std::vector<int> verdicts(4);
    for (double time_s = 0.0; time_s < seconds && vehicle.is_parked(); time_s += kPeriodS) {
      for (const std::size_t radar : {0U, 1U}) {
        if (vehicle.is_parked()) {
          ++verdicts[static_cast<std::size_t>(see(radar, {share, mps2 * time_s}))];
        }
      }
    }
    return verdicts;
  }

 private:
  Random random_;
  OdometryState state_{OdometryOptions(), kFrontAndRear};
  DopplerVelocityEstimator fit_;
  std::int64_t now_us_ = 1'000'000'000;

 public:
  ParkedVehicle vehicle{state_};
};

constexpr auto kStarted = static_cast<std::size_t>(Verdict::started);
constexpr auto kTwoWorlds = static_cast<std::size_t>(Verdict::two_worlds);

TEST_CASE("A vehicle is parked after a second, and nothing departs") {
  Parked parked(GENERATE(1U, 2U, 3U));
  REQUIRE(parked.vehicle.is_parked());
  for (int i = 0; i < 100; ++i) {
    CHECK(parked.see(static_cast<std::size_t>(i % 2), {}) == Verdict::rests);
  }
}

TEST_CASE("A start at rest counts to that second, a start with an unknown speed does not") {
  const double std_mps = GENERATE(0.05, 5.0);
  const OdometryState state(OdometryOptions(), kFrontAndRear);
  ParkedVehicle vehicle(state);
  Odometry odometry;
  odometry.utime_us = 1'000'000'000;
  odometry.twist_covariance(0, 0) = squared(std_mps);
  vehicle.add_output(odometry);
  odometry.utime_us += 1'100'000;
  vehicle.add_output(odometry);
  CHECK_FALSE(vehicle.is_parked());
  odometry.utime_us += 100'000;
  odometry.status = OdometryStatus::standing_still;
  vehicle.add_output(odometry);
  CHECK(vehicle.is_parked() == (std_mps < 1.0));
}

TEST_CASE("An own start is one world: it is never doubted, and told below 1.2 m/s") {
  const double acceleration_mps2 = GENERATE(-1.0, 0.1, 0.25, 0.5, 1.0, 2.0);
  Parked parked(GENERATE(1U, 2U, 3U));
  const auto verdicts =
      parked.accelerate(1.0, {-acceleration_mps2, 0.0}, 1.2 / std::abs(acceleration_mps2));
  CHECK(verdicts[kTwoWorlds] == 0);
  CHECK(verdicts[kStarted] == 1);
}

TEST_CASE("What departs while a share of the targets rests is no start") {
  const double share = GENERATE(0.3, 0.6, 0.85);
  const double acceleration_mps2 = GENERATE(-0.3, 0.1, 0.5, 2.0);
  CAPTURE(share, acceleration_mps2);
  Parked parked(GENERATE(1U, 2U, 3U));
  const auto verdicts =
      parked.accelerate(share, {acceleration_mps2, 0.0}, 4.0 / std::abs(acceleration_mps2));
  CHECK(verdicts[kStarted] == 0);
  CHECK(parked.vehicle.is_parked());
}

TEST_CASE("A train across the way is no start, though all targets are its own") {
  Parked parked(GENERATE(1U, 2U, 3U));
  const auto verdicts = parked.accelerate(1.0, {0.0, 0.5}, 6.0);
  CHECK(verdicts[kStarted] == 0);
  CHECK(verdicts[kTwoWorlds] > 20);
}

TEST_CASE("What one radar sees depart and the other at rest is no start") {
  Parked parked(GENERATE(1U, 2U, 3U));
  for (double mps = 0.0; mps < 3.0; mps += 0.05) {
    CHECK(parked.see(0, {1.0, {mps, 0.0}}) != Verdict::started);
    CHECK(parked.see(1, {}) != Verdict::started);
  }
}

TEST_CASE("As long as a start is not told the way and the velocity are within one sigma") {
  Parked parked(1);
  REQUIRE(parked.see(0, {1.0, {-0.3, 0.0}}) != Verdict::started);
  Odometry odometry;
  odometry.pose = odometry.odom_pose = odometry.motion = {0.2, 0.001, 0.01};
  odometry.twist = {0.3, 0.0, 0.02};
  parked.vehicle.widen(odometry);
  CHECK(std::sqrt(odometry.covariance(0, 0)) == Approx(0.2));
  CHECK(std::sqrt(odometry.odom_covariance(0, 0)) == Approx(0.2));
  CHECK(std::sqrt(odometry.motion_covariance(2, 2)) == Approx(0.01));
  CHECK(std::sqrt(odometry.twist_covariance(0, 0)) == Approx(0.3));
}

}  // namespace
}  // namespace cremed
