// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/vehicle/fault_cause.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

const std::vector<Pose2> kFourMounts{
    simulation::kFront, simulation::kRearLeft, simulation::kRearRight, {3.2, 0.8, 0.6}};

struct Twist {
  double v_mps;
  double w_radps;
};
using Driving = std::function<Twist(double time_s)>;

/// Brakes, accelerates and turns.
Twist town(double time_s) {
  return {8.0 + 4.0 * std::sin(0.6 * time_s), 0.3 * std::sin(0.5 * time_s)};
}
Twist straight(double /*time_s*/) { return {8.0, 0.0}; }

Eigen::Vector2d velocity_at(const Twist& motion, const Pose2& mount) {
  return {motion.v_mps - motion.w_radps * mount.y_m, motion.w_radps * mount.x_m};
}

Eigen::Matrix3d variances(double speed_std_mps, double yaw_rate_std_radps) {
  return Eigen::Vector3d(speed_std_mps, yaw_rate_std_radps, 0.0).cwiseAbs2().asDiagonal();
}

/// What a radar with a fault measures, in the axes of the vehicle by its configured mount.
using Fault = std::function<Eigen::Vector2d(const Driving&, double time_s, const Pose2& mount)>;

/// Compares what the radar measures with the motion by the others; `look` sees each result.
template <typename Look>
void compare(FaultCauseSearch& search, std::size_t radar, const Driving& drive, double duration_s,
             const Fault& fault, const Look& look) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (double time_s = 1000.0; time_s < 1000.0 + duration_s; time_s += 0.15) {
    const Twist motion = drive(time_s);
    search.add_motion(
        std::llround(time_s * 1e6),
        {motion.v_mps + 0.03 * normal(random), motion.w_radps + 0.005 * normal(random), 0.0},
        Eigen::Matrix3d::Zero());
    search.add_velocity(fault(drive, time_s, kFourMounts[radar]) +
                            Eigen::Vector2d(0.03 * normal(random), 0.08 * normal(random)),
                        Eigen::Matrix2d::Zero());
    look();
  }
}

FaultCause found(std::size_t radar, const Driving& drive, double duration_s, const Fault& fault,
                 std::uint32_t at_fault = 0) {
  FaultCauseSearch search(kFourMounts, radar);
  compare(search, radar, drive, duration_s, fault, [] {});
  return search.cause(at_fault | 1U << radar);
}

Fault scaled_by(double factor) {
  return [=](const Driving& drive, double time_s, const Pose2& mount) -> Eigen::Vector2d {
    return factor * velocity_at(drive(time_s), mount);
  };
}

/// In the direction of view.
Fault shifted_by(double mps) {
  return [=](const Driving& drive, double time_s, const Pose2& mount) -> Eigen::Vector2d {
    return velocity_at(drive(time_s), mount) +
           mps * Eigen::Vector2d(std::cos(mount.yaw_rad), std::sin(mount.yaw_rad));
  };
}

Fault late(double delay_s) {
  return [=](const Driving& drive, double time_s, const Pose2& mount) {
    return velocity_at(drive(time_s - delay_s), mount);
  };
}

/// The mount's yaw is this much more than the configured one.
Fault turned_by(double by_rad) {
  return [=](const Driving& drive, double time_s, const Pose2& mount) -> Eigen::Vector2d {
    return Eigen::Rotation2Dd(-by_rad) * velocity_at(drive(time_s), mount);
  };
}

Eigen::Vector2d upside_down(const Driving& drive, double time_s, const Pose2& mount) {
  const Eigen::Rotation2Dd vehicle_from_radar(mount.yaw_rad);
  Eigen::Vector2d seen = vehicle_from_radar.inverse() * velocity_at(drive(time_s), mount);
  seen.y() *= -1.0;
  return vehicle_from_radar * seen;
}

Fault of_mount(std::size_t other) {
  return [=](const Driving& drive, double time_s, const Pose2& mount) -> Eigen::Vector2d {
    return Eigen::Rotation2Dd(mount.yaw_rad - kFourMounts[other].yaw_rad) *
           velocity_at(drive(time_s), kFourMounts[other]);
  };
}

TEST_CASE("what is wrong with a radar is found, with what corrects it") {
  const auto radar = GENERATE(std::size_t{0}, std::size_t{1}, std::size_t{3});
  CAPTURE(radar);
  for (const double factor : {0.8, 0.9, 1.1, 1.25}) {
    const FaultCause cause = found(radar, town, 10.0, scaled_by(factor));
    CHECK(cause.kind == FaultKind::scale);
    CHECK(cause.value == Approx(1.0 / factor).margin(0.01));
  }
  for (const double by_rad : {-0.3, -0.1, 0.1, 0.3}) {
    const FaultCause cause = found(radar, town, 10.0, turned_by(by_rad));
    CHECK(cause.kind == FaultKind::mount_yaw);
    CHECK(cause.value == Approx(by_rad).margin(0.01));
  }
  for (const double delay_s : {0.3, 0.5}) {
    const FaultCause cause = found(radar, town, 10.0, late(delay_s));
    CHECK(cause.kind == FaultKind::late);
    CHECK(cause.value == Approx(delay_s).margin(0.06));
  }
  for (const double by_mps : {-0.8, -0.4, 0.4, 0.8}) {
    const FaultCause cause = found(radar, town, 10.0, shifted_by(by_mps));
    CHECK(cause.kind == FaultKind::offset);
    CHECK(cause.value == Approx(-by_mps).margin(0.06));
  }
  CHECK(found(radar, town, 10.0, scaled_by(-1.0)).kind == FaultKind::sign);
}

/// From 10 s on.
Fault beginning(const Fault& fault) {
  return [=](const Driving& drive, double time_s, const Pose2& mount) {
    return time_s < 1010.0 ? velocity_at(drive(time_s), mount) : fault(drive, time_s, mount);
  };
}

/// Whether the other radars ever seem to be late, on a drive of 20 s.
bool seem_others_late(const Fault& fault) {
  const Driving motorway = [](double time_s) -> Twist {
    return {30.0 + 4.0 * std::sin(0.5 * time_s), 0.0};
  };
  FaultCauseSearch search(kFourMounts, 0);
  bool is_late = false;
  compare(search, 0, motorway, 20.0, fault,
          [&] { is_late = is_late || search.find_others_late().is_clear; });
  return is_late;
}

TEST_CASE("the others are late if a radar seems early, not if its scale changes") {
  CHECK(seem_others_late(late(-0.5)));
  for (const double factor : {0.9, 0.96, 1.04, 1.1}) {
    CAPTURE(factor);
    CHECK_FALSE(seem_others_late(beginning(scaled_by(factor))));
  }
}

TEST_CASE("At one speed a scale is not told from an offset") {
  CHECK(found(0, straight, 10.0, scaled_by(1.05)).kind == FaultKind::unknown);
  CHECK(found(0, straight, 10.0, shifted_by(0.5)).kind == FaultKind::unknown);
}

TEST_CASE("a mount that is further ahead than configured is found in turns") {
  for (const double by_m : {-2.0, 2.0}) {
    const FaultCause cause =
        found(0, town, 10.0, [=](const Driving& drive, double time_s, const Pose2& mount) {
          return velocity_at(drive(time_s), {mount.x_m + by_m, mount.y_m, mount.yaw_rad});
        });
    CHECK(cause.kind == FaultKind::mount_x);
    CHECK(cause.value == Approx(by_m).margin(0.2));
  }
}

TEST_CASE("upside down is found at each mount that turns tell from another yaw") {
  for (const std::size_t radar : {0U, 1U, 3U}) {
    CHECK(found(radar, town, 10.0, upside_down).kind == FaultKind::upside_down);
  }
  CHECK(found(1, straight, 10.0, upside_down).kind != FaultKind::upside_down);
}

TEST_CASE("what a cause gains is nothing to a healthy radar, and much before the cause is clear") {
  const auto gain = [](const Driving& drive, const Fault& fault) {
    FaultCauseSearch search(kFourMounts, 0);
    for (double time_s = 1000.0; time_s < 1004.0; time_s += 0.15) {
      const Twist motion = drive(time_s);
      search.add_motion(std::llround(time_s * 1e6), {motion.v_mps, motion.w_radps, 0.0},
                        Eigen::Matrix3d::Zero());
      search.add_velocity(fault(drive, time_s, kFourMounts[0]), Eigen::Matrix2d::Zero());
    }
    return search.find();
  };
  const auto braking = [](double time_s) { return Twist{8.0 - 0.6 * (time_s - 1000.0), 0.0}; };
  CHECK(gain(town, scaled_by(1.0)).gain < 1.0);
  CHECK(gain(braking, late(0.3)).gain > 25.0);
  CHECK_FALSE(gain(braking, late(0.3)).is_clear);
  CHECK(gain(town, late(0.3)).is_clear);
}

TEST_CASE("others that know their yaw rate badly convict no radar by it") {
  const auto gain = [](double yaw_rate_std_radps) {
    FaultCauseSearch search(kFourMounts, 0);
    for (double time_s = 1000.0; time_s < 1010.0; time_s += 0.15) {
      const Twist motion = town(time_s);
      // A quarter too small: as if the front radar were further ahead.
      search.add_motion(std::llround(time_s * 1e6), {motion.v_mps, 0.75 * motion.w_radps, 0.0},
                        variances(0.0, yaw_rate_std_radps));
      search.add_velocity(velocity_at(motion, kFourMounts[0]), Eigen::Matrix2d::Zero());
    }
    return search.find().gain;
  };
  CHECK(gain(0.0) > 25.0);
  CHECK(gain(0.08) < 25.0);
}

/// What a cause gains within 30 s with few targets: random errors of 0.1 m/s along and 0.25 across,
/// and 0.03 rad/s of the others.
double most_gained(const Driving& drive, const Fault& fault, std::uint64_t seed) {
  const Eigen::Vector2d own_std(0.1, 0.25);
  const Eigen::Vector2d others_std(0.05, 0.03);  // m/s, rad/s
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  FaultCauseSearch search(kFourMounts, 0);
  double most = 0.0;
  for (double time_s = 1000.0; time_s < 1030.0; time_s += 0.15) {
    const Twist motion = drive(time_s);
    search.add_motion(std::llround(time_s * 1e6),
                      {motion.v_mps + others_std.x() * normal(random),
                       motion.w_radps + others_std.y() * normal(random), 0.0},
                      variances(others_std.x(), others_std.y()));
    const Eigen::Vector2d noise(own_std.x() * normal(random), own_std.y() * normal(random));
    search.add_velocity(fault(drive, time_s, kFourMounts[0]) + noise,
                        own_std.cwiseAbs2().asDiagonal());
    most = std::max(most, search.find().gain);
  }
  return most;
}

TEST_CASE("the noise of radars with few targets is no fault, at rest, straight and in turns") {
  const auto rest = [](double /*time_s*/) { return Twist{0.0, 0.0}; };
  for (const Driving& drive : {Driving(rest), Driving(straight), Driving(town)}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      CHECK(most_gained(drive, scaled_by(1.0), seed) < 25.0);
    }
  }
  CHECK(most_gained(town, scaled_by(0.9), 1) > 25.0);
  CHECK(most_gained(town, upside_down, 1) > 25.0);
  CHECK(most_gained(town, late(0.3), 1) > 25.0);
}

TEST_CASE("data of a radar at another mount are found with its number") {
  for (const auto& [radar, other] : {std::pair<std::size_t, std::size_t>{1, 2}, {3, 0}, {0, 3}}) {
    const FaultCause cause = found(radar, town, 10.0, of_mount(other), 1U << other);
    CAPTURE(radar, other);
    CHECK(cause.kind == FaultKind::exchanged);
    CHECK(cause.other == other);
  }
}

TEST_CASE("what a straight drive cannot tell apart is unknown") {
  CHECK(found(0, straight, 10.0, upside_down).kind == FaultKind::unknown);
  CHECK(found(0, straight, 10.0, late(0.3)).kind == FaultKind::unknown);
}

TEST_CASE("no fault, and one of another kind, is unknown") {
  CHECK(found(0, town, 10.0, scaled_by(1.0)).kind == FaultKind::unknown);
  CHECK(found(0, town, 10.0, [](const Driving&, double time_s, const Pose2&) {
          return Eigen::Vector2d(5.0 * std::sin(3.0 * time_s), 3.0);
        }).kind == FaultKind::unknown);
  CHECK(found(0, town, 0.5, scaled_by(0.8)).kind == FaultKind::unknown);
}

TEST_CASE("nothing is named before lateness can be told, and after a pause from then on") {
  const auto braking = [](double time_s) { return Twist{40.0 - 4.0 * (time_s - 1000.0), 0.0}; };
  CHECK(found(0, braking, 1.5, late(0.3)).kind == FaultKind::unknown);
  FaultCauseSearch search(kFourMounts, 0);
  const auto drive = [&](double from_s, double until_s, double factor) {
    for (double time_s = from_s; time_s < until_s; time_s += 0.15) {
      search.add_motion(std::llround(time_s * 1e6), {town(time_s).v_mps, town(time_s).w_radps, 0.0},
                        Eigen::Matrix3d::Zero());
      search.add_velocity(factor * velocity_at(town(time_s), kFourMounts[0]),
                          Eigen::Matrix2d::Zero());
    }
    return search.cause(1U);
  };
  CHECK(drive(10.0, 15.0, 0.8).kind == FaultKind::scale);
  CHECK(drive(15.6, 16.0, 0.9).kind == FaultKind::unknown);
  CHECK(drive(16.0, 20.0, 0.9).value == Approx(1.0 / 0.9).margin(0.01));
}

TEST_CASE("after the end of a fault the next one is found anew") {
  FaultCauseSearch search(kFourMounts, 0);
  const auto drive = [&](double from_s, const Fault& fault) {
    for (double time_s = from_s; time_s < from_s + 5.0; time_s += 0.15) {
      const Twist motion = town(time_s);
      search.add_motion(std::llround(time_s * 1e6), {motion.v_mps, motion.w_radps, 0.0},
                        Eigen::Matrix3d::Zero());
      search.add_velocity(fault(town, time_s, kFourMounts[0]), Eigen::Matrix2d::Zero());
    }
    return search.cause(1U).kind;
  };
  CHECK(drive(10.0, scaled_by(0.8)) == FaultKind::scale);
  search.clear();
  CHECK(search.cause(1U).kind == FaultKind::unknown);
  CHECK(drive(20.0, turned_by(0.2)) == FaultKind::mount_yaw);
}

}  // namespace
}  // namespace cremed
