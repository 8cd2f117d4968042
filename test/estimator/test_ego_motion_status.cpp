// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/motion/ego_motion_estimator.hpp"
#include "test/estimator/drive.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using numeric::radians;
using simulation::Drive;
using simulation::kFront;
using simulation::options_at;

/// The motion that the estimator returns for the second of two scans.
EgoMotion estimate(const EgoMotionOptions& options, Drive drive) {
  const auto estimator = std::make_unique<EgoMotionEstimator>(options);
  estimator->update(drive.next());
  EgoMotion motion = estimator->update(drive.next());
  CHECK(motion.motion.array().isNaN().any() != motion.has_estimate());
  CHECK(motion.covariance.array().isNaN().any() != motion.has_estimate());
  return motion;
}

TEST_CASE("each option's limit separates an estimate from its status") {
  struct Row {
    std::string what;
    Eigen::Vector3d velocity;
    void (*change)(EgoMotionOptions&);
    MotionStatus status;
  };
  const Eigen::Vector3d driving(10.0, 0.0, 0.2);
  const std::vector<Row> rows = {
      {"default options", driving, [](EgoMotionOptions&) {}, MotionStatus::ok},
      {"slow enough", driving, [](EgoMotionOptions& o) { o.max_speed_mps = 10.5; },
       MotionStatus::ok},
      {"too fast", driving, [](EgoMotionOptions& o) { o.max_speed_mps = 9.5; },
       MotionStatus::implausible},
      {"too fast backwards", -driving, [](EgoMotionOptions& o) { o.max_speed_mps = 9.5; },
       MotionStatus::implausible},
      {"turns slowly enough", driving, [](EgoMotionOptions& o) { o.max_yaw_rate_radps = 0.25; },
       MotionStatus::ok},
      {"turns too fast", driving, [](EgoMotionOptions& o) { o.max_yaw_rate_radps = 0.15; },
       MotionStatus::implausible},
      {"turns too fast to the right", -driving,
       [](EgoMotionOptions& o) { o.max_yaw_rate_radps = 0.15; }, MotionStatus::implausible},
      {"uncertain x", driving, [](EgoMotionOptions& o) { o.max_std_m = 1e-4; },
       MotionStatus::degenerate},
      {"certain x", driving, [](EgoMotionOptions& o) { o.max_std_m = 0.02; }, MotionStatus::ok},
      {"uncertain yaw", driving, [](EgoMotionOptions& o) { o.max_std_rad = 1e-5; },
       MotionStatus::degenerate},
      {"uncertain y", driving,
       [](EgoMotionOptions& o) {
         o.registration.degrees_of_freedom = 3;
         o.max_std_m = 0.001;
       },
       MotionStatus::degenerate},
      {"no time", driving,
       [](EgoMotionOptions& o) {
         o.registration.max_iterations = 1;
         o.registration.start_scale = 1.0;  // No first stage.
       },
       MotionStatus::no_convergence},
      {"nothing in view", driving, [](EgoMotionOptions& o) { o.limits.min_range_m = 299.0; },
       MotionStatus::too_few_targets},
  };
  for (const Row& row : rows) {
    CAPTURE(row.what);
    EgoMotionOptions options = options_at(kFront);
    row.change(options);
    CHECK(estimate(options, Drive(row.velocity, kFront, 2, 120)).status == row.status);
  }
}

TEST_CASE("an empty scan always has too few targets") {
  EgoMotionOptions options = options_at(kFront);
  options.min_targets = 0;
  options.limits.min_range_m = 299.0;
  CHECK(estimate(options, Drive({1.0, 0.0, 0.0}, kFront)).status == MotionStatus::too_few_targets);
}

TEST_CASE("targets in one place are degenerate in three states") {
  EgoMotionOptions options = options_at({});
  options.registration.degrees_of_freedom = 3;
  options.registration.outlier_ray.weight = 0.0;
  const auto estimator = std::make_unique<EgoMotionEstimator>(options);
  const simulation::Points points(10, Eigen::Vector2d(12.0, 3.0));
  for (const std::int64_t stamp_us : {0, 100000, 200000}) {
    const EgoMotion motion = estimator->update(simulation::scan(
        simulation::observe_all(points, Eigen::Vector3d::Zero(), Drive::kPeriodS, {}, {}),
        stamp_us));
    CHECK(motion.status == (stamp_us == 0 ? MotionStatus::no_reference : MotionStatus::degenerate));
    CHECK(motion.motion.array().isNaN().all());
  }
}

TEST_CASE("numbers out of range are rejected, and the estimator recovers") {
  EgoMotionOptions options = options_at(kFront);
  options.limits.max_range_m = 1e300;
  const auto estimator = std::make_unique<EgoMotionEstimator>(options);
  Drive drive({8.0, 0.0, 0.0}, kFront);
  estimator->update(drive.next());
  RadarScan huge = drive.next();
  huge.detections[3].range_m = 1e160;
  CHECK(estimator->update(huge).status == MotionStatus::non_finite);
  estimator->update(drive.next());
  CHECK(estimator->update(drive.next()).status == MotionStatus::ok);
}

TEST_CASE("a jump to another place is no motion, and the next scan has one") {
  int ambiguous = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto estimator = std::make_unique<EgoMotionEstimator>(options_at(kFront));
    Drive here({8.0, 0.0, 0.1}, kFront, 2 * seed);
    Drive there({8.0, 0.0, 0.1}, kFront, 2 * seed + 1);
    estimator->update(here.next());
    there.pass();
    const EgoMotion motion = estimator->update(there.next());
    CAPTURE(seed, to_string(motion.status));
    CHECK_FALSE(motion.has_estimate());
    CHECK(motion.motion.array().isNaN().all());
    CHECK(motion.covariance.array().isNaN().all());
    ambiguous += motion.status == MotionStatus::ambiguous ? 1 : 0;
    CHECK(estimator->update(there.next()).status == MotionStatus::ok);
  }
  CHECK(ambiguous > 25);
}

TEST_CASE("after a rejected motion the next one starts at its scan") {
  EgoMotionOptions options = options_at(kFront);
  options.max_speed_mps = 12.0;
  const auto estimator = std::make_unique<EgoMotionEstimator>(options);
  Drive drive({15.0, 0.0, 0.0}, kFront);
  estimator->update(drive.next());
  const RadarScan fast = drive.next();
  CHECK(estimator->update(fast).status == MotionStatus::implausible);
  drive.pass(-Drive::kPeriodUs);
  drive.set_velocity({5.0, 0.0, 0.0});
  drive.pass();
  const EgoMotion motion = estimator->update(drive.next());
  CHECK(motion.status == MotionStatus::ok);
  CHECK(motion.utime_start_us == fast.stamp_us);
  CHECK(motion.motion.x() == Approx(0.5).margin(0.05));
}

TEST_CASE("every speed of a road vehicle is found at once, also after lost scans") {
  const std::vector<Pose2> mounts = {
      kFront, {2.4, 0.8, radians(60.0)}, {-0.8, 0.6, radians(150.0)}};
  for (const Pose2& mount : mounts) {
    for (const double speed_mps : {-5.0, 2.0, 10.0, 20.0, 30.0, 45.0}) {
      for (const int lost : {0, 1, 3}) {
        Drive drive({speed_mps, 0.0, 0.0}, mount, 7, 250);
        const auto estimator = std::make_unique<EgoMotionEstimator>(options_at(mount));
        estimator->update(drive.next());
        for (int i = 0; i < lost; ++i) {
          drive.pass();
        }
        const EgoMotion motion = estimator->update(drive.next());
        CAPTURE(mount.yaw_rad, speed_mps, lost);
        REQUIRE(motion.status == MotionStatus::ok);
        CHECK(motion.motion.x() == Approx(speed_mps * Drive::kPeriodS * (lost + 1)).margin(0.1));
        CHECK(std::abs(motion.motion.z()) < 5.0 * std::sqrt(motion.covariance(2, 2)));
      }
    }
  }
}

TEST_CASE("after a gap no earlier motion is used") {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Drive drive({10.0, 0.0, 0.1}, kFront, seed, 150);
    const auto used = std::make_unique<EgoMotionEstimator>(options_at(kFront));
    const auto fresh = std::make_unique<EgoMotionEstimator>(options_at(kFront));
    used->update(drive.next());
    CHECK(used->update(drive.next()).status == MotionStatus::ok);
    drive.pass(1000000);
    const RadarScan scan = drive.next();
    CHECK(used->update(scan).status == MotionStatus::gap_too_long);
    CHECK(fresh->update(scan).status == MotionStatus::no_reference);
    const RadarScan next = drive.next();
    const EgoMotion a = used->update(next);
    const EgoMotion b = fresh->update(next);
    CHECK(a.motion == b.motion);
    CHECK(a.covariance == b.covariance);
  }
}

TEST_CASE("after lost scans a sideways radar continues its motion") {
  const Pose2 left{2.4, 0.8, radians(90.0)};
  EgoMotionOptions options = options_at(left);
  options.registration.doppler.enabled = false;
  Drive drive({10.0, 0.0, 0.0}, left, 9, 600);
  drive.set_half_view(radians(25.0));
  const auto estimator = std::make_unique<EgoMotionEstimator>(options);
  estimator->update(drive.next());
  CHECK(estimator->update(drive.next()).motion.x() == Approx(1.0).margin(0.1));
  for (int i = 0; i < 3; ++i) {
    drive.pass();
  }
  const EgoMotion motion = estimator->update(drive.next());
  REQUIRE(motion.status == MotionStatus::ok);
  CHECK(motion.motion.x() == Approx(4.0).margin(0.1));
}

TEST_CASE("a slow car's motion is as precise as Doppler") {
  EgoMotionOptions options = options_at(kFront);
  options.registration.start_scale = 2.0;
  options.registration.shared_errors = simulation::no_shared_errors();
  int vague = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Drive drive({1.3, 0.0, 0.0}, kFront, seed, 36);
    drive.set_noise({0.1, 0.01, 0.03});
    const auto estimator = std::make_unique<EgoMotionEstimator>(options);
    estimator->update(drive.next());
    drive.pass(-40000);  // 60 ms between the scans
    const EgoMotion motion = estimator->update(drive.next());
    vague += std::sqrt(motion.covariance(0, 0)) < 0.1 * 0.06 ? 0 : 1;
  }
  CHECK(vague == 0);
}

TEST_CASE("earlier estimates do not change later ones") {
  // The speed changes abruptly: the last velocity is one of several starts, not a prior.
  Drive drive({20.0, 0.0, 0.3}, kFront, 5, 120);
  const auto used = std::make_unique<EgoMotionEstimator>(options_at(kFront));
  for (int i = 0; i < 3; ++i) {
    used->update(drive.next());
  }
  drive.set_velocity({6.0, 0.0, -0.2});
  const auto fresh = std::make_unique<EgoMotionEstimator>(options_at(kFront));
  for (int i = 0; i < 5; ++i) {
    const RadarScan scan = drive.next();
    const EgoMotion a = used->update(scan);
    const EgoMotion b = fresh->update(scan);
    if (i > 0) {
      REQUIRE(a.status == MotionStatus::ok);
      REQUIRE(b.status == MotionStatus::ok);
      CHECK(numeric::normalised_error(a.motion - b.motion, b.covariance, 2) < 0.1 * 0.1);
    }
  }
}

TEST_CASE("few matched targets are enough for a motion that continues the previous one") {
  int continued = 0;
  int at_first = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    for (const int scans_before : {1, 4}) {
      Drive drive({8.0, 0.0, 0.3}, kFront, seed, 120);
      const auto estimator = std::make_unique<EgoMotionEstimator>(options_at(kFront));
      for (int i = 0; i < scans_before; ++i) {
        estimator->update(drive.next());
      }
      drive.renew(0.85);
      const EgoMotion motion = estimator->update(drive.next());
      (scans_before == 1 ? at_first : continued) += motion.has_estimate() ? 1 : 0;
      if (motion.has_estimate()) {
        const Eigen::Vector3d error = motion.motion - drive.motion_per_period();
        CHECK(numeric::normalised_error(error, motion.covariance, 2) < 25.0);
      }
    }
  }
  CHECK(continued >= 36);
  CHECK(at_first <= 20);
}

TEST_CASE("a change beyond a vehicle's limits is no continuation") {
  EgoMotionOptions options = options_at(kFront);
  options.registration.doppler.enabled = false;  // Doppler would show the continuation.
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Drive drive({8.0, 0.0, 0.3}, kFront, seed, 120);
    const auto estimator = std::make_unique<EgoMotionEstimator>(options);
    for (int i = 0; i < 4; ++i) {
      estimator->update(drive.next());
    }
    drive.renew(0.85);
    RadarScan turned = drive.next();
    for (int k = 0; k < turned.count; ++k) {
      turned.detections.at(static_cast<std::size_t>(k)).azimuth_rad += 0.2;
    }
    wrong += estimator->update(turned).has_estimate() ? 1 : 0;
  }
  CHECK(wrong <= 2);
}

}  // namespace
}  // namespace cremed
