// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/measurement/map_measurement.hpp"
#include "cremed/estimator/fusion/odometry_filter.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/scan/squared.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using namespace state_layout;
using simulation::kPeriodS;

/// Speed of a vehicle in town: accelerates, drives, brakes and stands, 10 s each.
double town_speed_mps(double time_s) {
  const double in_cycle_s = std::fmod(time_s, 40.0);
  if (in_cycle_s < 10.0) {
    return 1.4 * in_cycle_s;
  }
  return in_cycle_s < 20.0 ? 14.0 : std::max(0.0, 14.0 - 1.4 * (in_cycle_s - 20.0));
}

/// A drive straight ahead with true Doppler. After the first minute only the first `heard` radars
/// send. `visit(time_s)` after the scans of each time.
template <typename Visit>
void drive_in_town(OdometryState& state, double minutes, std::size_t heard, Visit visit) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (std::int64_t i = 1; static_cast<double>(i) * kPeriodS < 60.0 * minutes; ++i) {
    const double time_s = static_cast<double>(i) * kPeriodS;
    state.advance_to(std::llround(time_s * 1e6));
    for (std::size_t radar = 0; radar < (time_s < 60.0 ? state.radars() : heard); ++radar) {
      state.hear(radar, state.time_us());
      state.advance_errors(radar, kPeriodS);
      DopplerVelocity velocity;
      velocity.covariance << 4e-4, 0.0, 0.0, 25e-4;
      velocity.per_offset = {state.mount(radar).x_m > 0.0 ? -1.1 : 1.1, 0.0};
      velocity.velocity_mps = {town_speed_mps(time_s) + 0.02 * normal(random),
                               0.05 * normal(random)};
      state.update(
          state.gaussian.innovate(DopplerMeasurement{state, radar, 0.0}.linearise(velocity)));
    }
    visit(time_s);
  }
}

/// Largest relative error of the speed at 14 m/s in the last minute.
double speed_error_after(double minutes, const std::vector<Pose2>& mounts, std::size_t heard) {
  OdometryState state(OdometryOptions(), mounts);
  state.start();
  double error = 0.0;
  drive_in_town(state, minutes, heard, [&](double time_s) {
    if (time_s > 60.0 * (minutes - 1.0) && town_speed_mps(time_s) == 14.0) {
      error = std::max(error, std::abs(state.gaussian.mean(kSpeed) / 14.0 - 1.0));
    }
  });
  return error;
}

TEST_CASE("Doppler scales are learned only with a radar near the direction of travel") {
  const double yaw_rad = GENERATE(0.0, 0.4, 0.5, 0.75);
  CAPTURE(yaw_rad);
  const double back_rad = std::numbers::pi - yaw_rad;
  OdometryState state(
      OdometryOptions(),
      {{3.5, 0.7, yaw_rad}, {3.5, -0.7, -yaw_rad}, {-0.6, 0.7, back_rad}, {-0.6, -0.7, -back_rad}});
  state.start();
  const int scale = state.error(0, kDopplerScale);
  const double prior = state.gaussian.std(scale);
  drive_in_town(state, 2.0, state.radars(), [](double) {});
  if (yaw_rad < 0.45) {
    CHECK(state.gaussian.std(scale) < 0.8 * prior);
  } else {
    CHECK(state.gaussian.std(scale) == Approx(prior));
  }
}

TEST_CASE("an hour of accelerating and braking does not change the scale of speed") {
  const std::vector<Pose2> one{{3.4, 0.0, 0.0}};
  const std::vector<Pose2> two{{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.1}};
  const std::vector<Pose2> three{{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.1}, {-0.6, -0.6, -3.1}};
  const std::vector<Pose2> corners{{3.5, 0.7, 0.8}, {3.5, -0.7, -0.8}};
  const auto& mounts = GENERATE_REF(one, two, three, corners);
  const double at_start = speed_error_after(2.0, mounts, mounts.size());
  const double after_an_hour = speed_error_after(60.0, mounts, mounts.size());
  CAPTURE(mounts.size(), at_start, after_an_hour);
  CHECK(at_start < 0.006);
  CHECK(after_an_hour < 0.006);  // The scale's prior has a sigma of 0.0028.
}

TEST_CASE("a radar whose partners fall silent does not change the scale of speed in an hour") {
  const std::vector<Pose2> front_first{{3.4, 0.0, 0.0}, {-0.6, 0.6, 3.1}};
  const std::vector<Pose2> corners_first{{3.5, 0.7, 0.8}, {3.5, -0.7, -0.8}, {3.4, 0.0, 0.0}};
  const auto& mounts = GENERATE_REF(front_first, corners_first);
  CHECK(speed_error_after(60.0, mounts, mounts.size() - 1) < 0.006);
}

TEST_CASE("lateral radars are witnesses while one ahead is heard, and after a silence of all") {
  OdometryState state(OdometryOptions(), {{3.4, 0.0, 0.0}, {0.0, 0.9, 1.6}});
  state.start();
  const auto hear = [&](std::size_t radar, double time_s) {
    const auto time_us = static_cast<std::int64_t>(1e6 * time_s);
    state.hear(radar, time_us);
    state.advance_to(time_us);
    return state.is_witness(1);
  };
  CHECK(hear(1, 100.0));
  CHECK(hear(1, 100.4));
  CHECK_FALSE(hear(1, 100.6));
  CHECK(hear(0, 100.7));
  CHECK(hear(1, 101.1));
  CHECK_FALSE(hear(1, 101.3));
  CHECK(hear(1, 103.0));
  CHECK(hear(1, 103.4));
  CHECK_FALSE(hear(1, 103.6));
  state.leave_clock();
  state.restart(50'000'000);
  CHECK(hear(1, 50.0));
}

/// A drive in bends with one radar, whose Doppler is true and whose positions have noise.
class BendyDrive {
 public:
  explicit BendyDrive(std::uint64_t seed_of_y_and_yaw)
      : random_of_y_and_yaw_(seed_of_y_and_yaw), state_(OdometryOptions(), {kMount}) {
    state_.start();
  }

  void scan() {
    const double dt_s = kPeriodS;
    ++scans_;
    const double w = 0.6 * std::sin(0.6 * dt_s * static_cast<double>(scans_));
    truth_ = composed_pose(truth_, {kSpeedMps * dt_s, 0.5 * kSpeedMps * w * dt_s * dt_s, w * dt_s});
    state_.advance_to(std::llround(dt_s * static_cast<double>(scans_) * 1e6));
    state_.advance_errors(0, dt_s);
    measure_doppler(w);
    if (scans_ > kNodes * kScansOfNode) {
      measure_positions();
    }
    if (scans_ % kScansOfNode == 0) {
      const auto node = static_cast<std::size_t>(scans_ / kScansOfNode) % kNodes;
      state_.clone_node(node, 0.0);
      true_nodes_[node] = truth_;
    }
  }
  [[nodiscard]] double doppler_scale() const {
    return state_.gaussian.mean(kCommonScale) +
           state_.gaussian.mean(state_.error(0, kDopplerScale));
  }

 private:
  static constexpr Pose2 kMount{3.4, 0.0, 0.0};
  static constexpr double kSpeedMps = 10.0;
  static constexpr int kScansOfNode = 7;

  void measure_doppler(double w) {
    DopplerVelocity velocity;
    velocity.covariance << 4e-4, 0.0, 0.0, 25e-4;
    velocity.velocity_mps = {kSpeedMps + 0.02 * normal_(random_),
                             w * kMount.x_m + 0.05 * normal_(random_)};
    state_.update(state_.gaussian.innovate(DopplerMeasurement{state_, 0, 0.0}.linearise(velocity)));
  }

  /// A registration in which each node has the same share.
  void measure_positions() {
    MapMatch match;
    match.covariance = Eigen::Vector3d(9e-4, 9e-3, 2e-5).asDiagonal();
    TargetSet one;
    one.add(Target());
    match.correction = {0.03 * normal_(random_), 0.1 * normal_of_y_and_yaw_(random_of_y_and_yaw_),
                        0.0045 * normal_of_y_and_yaw_(random_of_y_and_yaw_)};
    const Eigen::Vector3d now = state_.gaussian.mean().head<kPose>();
    for (std::size_t i = 0; i < kNodes; ++i) {
      match.by_node[i] = Eigen::Matrix3d::Identity() / static_cast<double>(kNodes);
      map_->insert(i, one, kMount, Eigen::Vector3d::Zero());
      const Eigen::Vector3d by_node =
          composed_pose(state_.node_pose(i), relative_pose(true_nodes_[i], truth_));
      match.correction += match.by_node[i] * relative_pose(now, by_node);
    }
    const MapMeasurement measurement{state_, *map_, 0, 0.0};
    map_->place(measurement.now_from_node());
    state_.update(state_.gaussian.innovate(measurement.linearise(match, true)), true);
  }

  std::mt19937_64 random_{1};
  std::mt19937_64 random_of_y_and_yaw_;
  OdometryState state_;
  std::unique_ptr<TargetMap> map_ = std::make_unique<TargetMap>();
  Eigen::Vector3d truth_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, kNodes> true_nodes_{};
  std::normal_distribution<double> normal_;
  std::normal_distribution<double> normal_of_y_and_yaw_;
  int scans_ = 0;
};

TEST_CASE("the noise of y and yaw by positions does not change the scale of speed") {
  BendyDrive one(1);
  BendyDrive other(2);
  double squares = 0.0;
  constexpr int kScans = 8000;
  for (int i = 0; i < kScans; ++i) {
    one.scan();
    other.scan();
    squares += squared(one.doppler_scale() - other.doppler_scale());
  }
  CHECK(std::sqrt(squares / kScans) < 0.0002);  // If it does: 0.0005.
}

/// A straight road between two hedges, with three points a metre that a radar sees up to 0.3 m
/// off, the fewer of them the farther away.
class HedgeDrive {
 public:
  explicit HedgeDrive(std::uint64_t seed)
      : random_(seed), filter_(OdometryOptions(), {kMounts[0], kMounts[1]}) {
    for (double x_m = -100.0; x_m < 2000.0; x_m += simulation::uniform(random_, 0.0, 0.67)) {
      const double side = points_.size() % 2 == 0 ? 1.0 : -1.0;
      points_.emplace_back(x_m, side * simulation::uniform(random_, 4.5, 6.0));
    }
  }

  Odometry next() {
    const std::size_t radar = scans_++ % kMounts.size();
    way_m_ += kSpeedMps * 0.5 * kPeriodS;
    return filter_.update(radar, see(kMounts[radar]),
                          std::llround(1e6 * 0.5 * kPeriodS * static_cast<double>(scans_)));
  }

  static constexpr double kSpeedMps = 25.0;

 private:
  static constexpr std::array kMounts{simulation::kFront, simulation::kRearLeft};

  TargetSet see(const Pose2& mount) {
    std::normal_distribution<double> normal;
    simulation::Detections detections;
    for (const Eigen::Vector2d& point : points_) {
      if (std::abs(point.x() - way_m_) > 80.0) {
        continue;
      }
      const Eigen::Vector2d at(point.x() - way_m_ + 0.3 * normal(random_),
                               point.y() + 0.3 * normal(random_));
      Detection detection = simulation::observe(at, {kSpeedMps, 0.0, 0.0}, mount, {0.3, 0.0, 0.1});
      detection.azimuth_std_rad = 0.6 / detection.range_m;
      detection.doppler_mps += detection.doppler_std_mps * normal(random_);
      // Half of them at 34 m, fewer off its axis.
      const double decibels = -40.0 * std::log10(detection.range_m / 34.0) -
                              12.0 * squared(detection.azimuth_rad) + 4.0 * normal(random_);
      if (std::abs(detection.azimuth_rad) < 1.1 && detection.range_m < 70.0 && decibels > 0.0) {
        detections.push_back(detection);
      }
    }
    return simulation::targets(detections, mount);
  }

  simulation::Random random_;
  simulation::Points points_;
  OdometryFilter filter_;
  std::size_t scans_ = 0;
  double way_m_ = 0.0;
};

TEST_CASE("chance neighbours in a dense hedge do not make the speed wrong beyond its sigma") {
  HedgeDrive drive(GENERATE(1U, 2U, 3U));
  double error_mps = 0.0;
  double sigma_mps = 0.0;
  constexpr int kScans = 1600;
  constexpr int kLast = 200;
  for (int i = 0; i < kScans; ++i) {
    const Odometry odometry = drive.next();
    if (i >= kScans - kLast) {
      error_mps += (odometry.twist.x() - HedgeDrive::kSpeedMps) / kLast;
      sigma_mps += std::sqrt(odometry.twist_covariance(0, 0)) / kLast;
    }
  }
  CAPTURE(error_mps, sigma_mps);
  CHECK(std::abs(error_mps) < 2.0 * sigma_mps);  // Without p_c: 2.3 to 2.7 times.
  CHECK(sigma_mps < 0.004 * HedgeDrive::kSpeedMps);
}

}  // namespace
}  // namespace cremed
