// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/measurement/position_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/fusion/state/vehicle_motion.hpp"
#include "test/estimator/numeric.hpp"

namespace cremed {
namespace {

using namespace state_layout;

const std::vector<Pose2> kMounts{{3.4, 0.1, 0.02}, {2.4, 0.8, 1.54}};

/// A state without zeros, of a vehicle in a turn.
OdometryState busy_state(const OdometryOptions& options) {
  OdometryState state(options, kMounts);
  state.start();
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-0.02, 0.02);
  for (int i = 0; i < state.gaussian.size(); ++i) {
    state.gaussian.set_mean(i, uniform(random));
  }
  const std::vector<std::pair<int, double>> values{{kX, 3.0},
                                                   {kY, -1.0},
                                                   {kYaw, 0.7},
                                                   {kSpeed, 8.0},
                                                   {kAcceleration, -1.2},
                                                   {kYawRate, 0.4},
                                                   {kYawAcceleration, 0.3}};
  for (const auto& [which, value] : values) {
    state.gaussian.set_mean(which, value);
  }
  for (std::size_t radar = 0; radar < kMounts.size(); ++radar) {
    for (int i = 0; i < kPose; ++i) {
      state.gaussian.set_mean(state.scan(radar) + i, 2.5 - i + 0.1 * static_cast<double>(radar));
      state.gaussian.set_mean(state.keyframe(radar, 1) + i, -1.5 + 0.6 * i);
    }
  }
  return state;
}

/// The measurement's derivatives against differences of its residual.
template <typename Measure>
void check_jacobian(OdometryState& state, const Measure& measure) {
  constexpr double kStep = 1e-6;
  const LinearMeasurement measurement = measure();
  Eigen::Matrix2Xd jacobian = Eigen::Matrix2Xd::Zero(2, state.gaussian.size());
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    jacobian.col(measurement.state[i]) += measurement.jacobian[i];
  }
  for (int i = 0; i < state.gaussian.size(); ++i) {
    const double value = state.gaussian.mean(i);
    state.gaussian.set_mean(i, value + kStep);
    const Eigen::Vector2d above = measure().residual;
    state.gaussian.set_mean(i, value - kStep);
    const Eigen::Vector2d below = measure().residual;
    state.gaussian.set_mean(i, value);
    const Eigen::Vector2d expected = (below - above) / (2.0 * kStep);
    CAPTURE(i, jacobian.col(i).transpose(), expected.transpose());
    CHECK((jacobian.col(i) - expected).norm() < 1e-6 * (1.0 + expected.norm()));
  }
}

TEST_CASE("derivatives of the measured Doppler are those of its residual") {
  const OdometryOptions options;
  OdometryState state = busy_state(options);
  DopplerVelocity velocity;
  velocity.velocity_mps = {7.5, 1.0};
  velocity.per_offset = {-1.1, 0.3};
  const double age_s = GENERATE(0.0, 0.05);
  const auto radar = GENERATE(std::size_t{0}, std::size_t{1});
  // Slower than 1 m/s the share of a driving vehicle's errors changes, which derivatives leave out.
  check_jacobian(state, [&] {
    return DopplerMeasurement{state, radar, age_s}.linearise(velocity);
  });
}

TEST_CASE("derivatives of a registered pair are those of its residual") {
  const OdometryOptions options;
  OdometryState state = busy_state(options);
  const auto radar = GENERATE(std::size_t{0}, std::size_t{1});
  check_jacobian(state, [&] {
    return PositionMeasurement{state, radar, 1}.linearise({4.0, 0.1, 0.2});
  });
}

TEST_CASE("a registration's start is what the measurement expects") {
  const OdometryOptions options;
  const OdometryState state = busy_state(options);
  const Eigen::Vector3d scan = state.gaussian.mean().segment<3>(state.scan(1));
  const PositionMeasurement measurement{state, 1, 1};
  CHECK(measurement.linearise(measurement.expected_motion(scan)).residual.norm() < 1e-12);
}

TEST_CASE("derivatives of the motion are those of the motion, forward and back") {
  const OdometryOptions options;
  const OdometryState state = busy_state(options);
  const MotionStep::Vector at = state.gaussian.mean().head<kMotionStates>();
  const double dt_s = GENERATE(0.07, 0.0, -0.05);
  const MotionStep step = moved(at, dt_s, options);
  const auto expected = numeric::central_differences(
      at, 1e-6, [&](const MotionStep::Vector& x) { return moved(x, dt_s, options).state; });
  CHECK((step.jacobian - expected).cwiseAbs().maxCoeff() < 1e-7);
}

TEST_CASE("the motion is that of a vehicle on a circle") {
  OdometryOptions options;
  MotionStep::Vector state = MotionStep::Vector::Zero();
  state(kSpeed) = 10.0;
  state(kYawRate) = 0.5;
  for (int i = 0; i < 100; ++i) {
    state = moved(state, 0.01, options).state;
  }
  CHECK(state(kYaw) == Approx(0.5));
  CHECK(state(kX) == Approx(20.0 * std::sin(0.5)).epsilon(1e-5));
  CHECK(state(kY) == Approx(20.0 * (1.0 - std::cos(0.5))).epsilon(1e-5));
}

TEST_CASE("noise of the motion does not depend on how time is cut") {
  const OdometryOptions options;
  const MotionStep::Vector at = MotionStep::Vector::Unit(kSpeed) * 8.0;
  const MotionStep whole = moved(at, 0.1, options);
  const MotionStep first = moved(at, 0.04, options);
  const MotionStep second = moved(first.state, 0.06, options);
  const MotionStep::Matrix noise =
      second.jacobian * first.noise * second.jacobian.transpose() + second.noise;
  for (const int i :
       {+kSpeed, +kAcceleration, +kYawRate, +kYawAcceleration, +kSlip, +kBodyVelocity}) {
    CAPTURE(i);
    // Accelerations decay by a tenth to a fifth in that time.
    CHECK(noise(i, i) == Approx(whole.noise(i, i)).epsilon(0.2));
  }
}

TEST_CASE("derivatives of a relative pose are those of the pose") {
  using Poses = Eigen::Matrix<double, 6, 1>;
  const Poses at = (Poses() << 1.0, -2.0, 0.8, 4.0, 1.0, 1.1).finished();
  const Eigen::Vector3d relative = relative_pose(at.head<3>(), at.tail<3>());
  const auto expected = numeric::central_differences(
      at, 1e-6,
      [](const Poses& x) -> Eigen::Vector3d { return relative_pose(x.head<3>(), x.tail<3>()); });
  CHECK((relative_pose_jacobian(at.head<3>(), relative) - expected).norm() < 1e-7);
  CHECK((composed_pose(at.head<3>(), relative) - at.tail<3>()).norm() < 1e-12);
}

TEST_CASE("a new anchor changes no pose relative to another, nor what is known of it") {
  const OdometryOptions options;
  OdometryState state(options, kMounts);
  state.start();
  state.gaussian.set(kSpeed, 8.0, 0.1);
  state.gaussian.set(kYawRate, 0.3, 0.01);
  state.clone_scan(0, 0.0, 0.01 * Eigen::Matrix3d::Identity());
  state.keep_scan(0, 2);
  state.advance_to(800'000);
  state.clone_scan(0, 0.03, 0.02 * Eigen::Matrix3d::Identity());
  state.advance_to(900'000);
  const int from = state.keyframe(0, 2);
  const int to = state.scan(0);
  const auto relative = [&](Eigen::Matrix3d& covariance) {
    const Eigen::Vector3d a = state.gaussian.mean().segment<3>(from);
    const Eigen::Vector3d pose = relative_pose(a, state.gaussian.mean().segment<3>(to));
    const std::array<int, 6> both{from, from + 1, from + 2, to, to + 1, to + 2};
    const Eigen::Matrix<double, 6, 6> joint = state.gaussian.covariance()(both, both);
    const auto jacobian = relative_pose_jacobian(a, pose);
    covariance = jacobian * joint * jacobian.transpose();
    return pose;
  };
  Eigen::Matrix3d before;
  Eigen::Matrix3d after;
  const Eigen::Vector3d pose = relative(before);
  state.renew_anchor();
  CHECK((relative(after) - pose).norm() < 1e-12);
  CHECK((after - before).norm() < 1e-9 * before.norm());
  CHECK(state.gaussian.mean().head<3>().norm() == 0.0);
  CHECK(state.gaussian.covariance().topRows<3>().norm() == 0.0);
}

}  // namespace
}  // namespace cremed
