// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/motion/speed_check.hpp"

using namespace cremed;

namespace {

constexpr double kPeriodS = 0.075;
constexpr double kWorldM = 400.0;

/// A radar in front of a car that drives a circle among static points.
struct CircleDrive {
  double speed_mps = 10.0;
  double yaw_rate_radps = 0.0;
  double doppler_factor = 1.0;  ///< Factor on the reported Doppler: 0 if stuck.
  double pace = 1.0;            ///< Rate of the stamps.
  int things = 2000;            ///< On kWorldM x kWorldM.
  double kept = 0.8;            ///< Share that is detected in a scan.
};

/// The check after a few seconds of driving.
class CheckedDrive {
 public:
  void go_on(const CircleDrive& drive, double duration_s) {
    const std::vector<Eigen::Vector2d> world = things(drive.things);
    for (double t_s = 0.0; t_s < duration_s; t_s += kPeriodS) {
      yaw_ += drive.yaw_rate_radps * kPeriodS;
      place_ += drive.speed_mps * kPeriodS * Eigen::Vector2d(std::cos(yaw_), std::sin(yaw_));
      stamp_us_ += std::llround(drive.pace * kPeriodS * 1e6);
      check.add(seen(world, drive), stamp_us_);
    }
  }

  SpeedCheck check;

 private:
  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  double normal(double std) { return std::normal_distribution<double>(0.0, std)(random_); }

  static std::vector<Eigen::Vector2d> things(int count) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> anywhere(0.0, kWorldM);
    std::vector<Eigen::Vector2d> result;
    for (int i = 0; i < count; ++i) result.emplace_back(anywhere(random), anywhere(random));
    return result;
  }

  /// The world is periodic.
  static Eigen::Vector2d wrapped(const Eigen::Vector2d& way) {
    return {std::remainder(way.x(), kWorldM), std::remainder(way.y(), kWorldM)};
  }

  TargetSet seen(const std::vector<Eigen::Vector2d>& world, const CircleDrive& drive) {
    const Pose2 mount{3.4, 0.0, 0.0};
    const Eigen::Rotation2Dd to_vehicle(-yaw_);
    TargetSet targets;
    for (const Eigen::Vector2d& thing : world) {
      const Eigen::Vector2d p =
          to_vehicle * wrapped(thing - place_) - Eigen::Vector2d(mount.x_m, 0.0);
      Detection detection;
      detection.range_m = p.norm() + normal(0.15);
      detection.azimuth_rad = std::atan2(p.y(), p.x()) + normal(0.008);
      const Eigen::Vector2d velocity(drive.speed_mps, drive.yaw_rate_radps * mount.x_m);
      detection.doppler_mps = -drive.doppler_factor * velocity.dot(p.normalized()) + normal(0.1);
      detection.range_std_m = 0.15;
      detection.azimuth_std_rad = 0.008;
      detection.doppler_std_mps = 0.1;
      const bool is_in_view = std::abs(detection.azimuth_rad) < 0.9 && p.norm() < 60.0;
      if (is_in_view && uniform(0.0, 1.0) < drive.kept && targets.size() < 120) {
        targets.add(detection, mount);
      }
    }
    return targets;
  }

  std::mt19937_64 random_{11};
  Eigen::Vector2d place_ = Eigen::Vector2d::Zero();
  double yaw_ = 0.0;
  std::int64_t stamp_us_ = 1'700'000'000'000'000;
};

}  // namespace

TEST_CASE("Speed check: what is true is checked and not doubted, at any speed") {
  const double speed_mps = GENERATE(-5.0, 0.0, 1.0, 5.0, 12.0, 25.0, 35.0);
  const double yaw_rate_radps = GENERATE(-0.3, 0.0, 0.15);
  CAPTURE(speed_mps, yaw_rate_radps);
  CheckedDrive drive;
  for (int second = 0; second < 20; ++second) {
    drive.go_on({.speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps}, 1.0);
    CHECK_FALSE(drive.check.is_contradicted());
  }
  CHECK(drive.check.is_checked());
}

TEST_CASE("Speed check: Doppler that is stuck shows within 1.5 s of driving, and its end too") {
  const double speed_mps = GENERATE(-5.0, 4.0, 10.0, 25.0);
  const double yaw_rate_radps = GENERATE(-0.3, 0.0, 0.15);
  CAPTURE(speed_mps, yaw_rate_radps);
  const CircleDrive healthy{.speed_mps = speed_mps, .yaw_rate_radps = yaw_rate_radps};
  CircleDrive stuck = healthy;
  stuck.doppler_factor = 0.0;
  CheckedDrive drive;
  drive.go_on(healthy, 3.0);
  drive.go_on(stuck, 1.5);
  CHECK(drive.check.is_contradicted());
  drive.go_on(healthy, 1.5);
  CHECK_FALSE(drive.check.is_contradicted());
}

TEST_CASE("Speed check: stamps at half or twice the pace of time show within 2 s") {
  const double pace = GENERATE(0.5, 2.0);
  const double speed_mps = GENERATE(5.0, 12.0);
  CAPTURE(pace, speed_mps);
  CheckedDrive drive;
  drive.go_on({.speed_mps = speed_mps, .pace = pace}, 2.0);
  CHECK(drive.check.is_contradicted());
}

TEST_CASE("Speed check: where nothing is found again, nothing is checked, and nothing doubted") {
  const auto drive =
      GENERATE(CircleDrive{.things = 0}, CircleDrive{.things = 60}, CircleDrive{.kept = 0.02});
  CheckedDrive checked;
  checked.go_on(drive, 20.0);
  CHECK_FALSE(checked.check.is_contradicted());
  CHECK_FALSE(checked.check.is_checked());
}

TEST_CASE("Speed check: a silence, stamps that go back and a clock that is set are no speed") {
  CheckedDrive drive;
  drive.go_on({}, 3.0);
  drive.go_on({.pace = 40.0}, 0.3);
  drive.go_on({.pace = -40.0}, 0.3);
  drive.check.forget();
  CHECK_FALSE(drive.check.is_contradicted());
  drive.go_on({}, 3.0);
  CHECK_FALSE(drive.check.is_contradicted());
  CHECK(drive.check.is_checked());
}
