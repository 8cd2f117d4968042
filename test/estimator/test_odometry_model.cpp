// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/map/map_registration.hpp"
#include "cremed/estimator/fusion/measurement/doppler_measurement.hpp"
#include "cremed/estimator/fusion/measurement/map_measurement.hpp"
#include "cremed/estimator/fusion/state/odometry_state.hpp"
#include "cremed/estimator/fusion/state/pose_chain.hpp"
#include "cremed/estimator/fusion/state/vehicle_motion.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using namespace state_layout;
using simulation::kTwoMounts;

/// Nodes with a scan.
constexpr std::size_t kMapNodes = 3;

/// A state in which nothing is zero, of a vehicle in a turn.
OdometryState busy_state(const OdometryOptions& options) {
  OdometryState state(options, kTwoMounts);
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
                                                   {kYawAcceleration, 0.3},
                                                   {kSlipPerAcceleration, 0.004}};
  for (const auto& [which, value] : values) {
    state.gaussian.set_mean(which, value);
  }
  for (std::size_t i = 0; i < kMapNodes; ++i) {
    const double age = static_cast<double>(kMapNodes - i);
    const Eigen::Vector3d pose(3.0 - 1.9 * age, -1.0 - 1.2 * age + 0.1 * age * age,
                               0.7 - 0.1 * age);
    for (int k = 0; k < kPose; ++k) {
      state.gaussian.set_mean(node(i) + k, pose(k));
    }
  }
  return state;
}

/// Compares the Jacobian of a measurement with differences of its residual.
template <typename Measure>
void check_jacobian(OdometryState& state, const Measure& measure) {
  constexpr double kStep = 1e-6;
  const LinearMeasurement measurement = measure();
  Eigen::Matrix3Xd jacobian = Eigen::Matrix3Xd::Zero(3, state.gaussian.size());
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    jacobian.col(measurement.state[i]) += measurement.jacobian[i];
  }
  for (int i = 0; i < state.gaussian.size(); ++i) {
    const double value = state.gaussian.mean(i);
    state.gaussian.set_mean(i, value + kStep);
    const Eigen::Vector3d above = measure().residual;
    state.gaussian.set_mean(i, value - kStep);
    const Eigen::Vector3d below = measure().residual;
    state.gaussian.set_mean(i, value);
    const Eigen::Vector3d expected = (below - above) / (2.0 * kStep);
    CAPTURE(i, jacobian.col(i).transpose(), expected.transpose());
    CHECK((jacobian.col(i) - expected).norm() < 1e-6 * (1.0 + expected.norm()));
  }
}

TEST_CASE("the Jacobian of the Doppler measurement is the derivative of its residual") {
  const OdometryOptions options;
  OdometryState state = busy_state(options);
  DopplerVelocity velocity;
  velocity.velocity_mps = {7.5, 1.0};
  velocity.per_offset = {-1.1, 0.3};
  const double age_s = GENERATE(0.0, 0.05);
  const auto radar = GENERATE(std::size_t{0}, std::size_t{1});
  // Below 1 m/s the factor on a driving vehicle's errors changes, which the Jacobian neglects.
  check_jacobian(state, [&] {
    return DopplerMeasurement{state, radar, age_s}.linearise(velocity);
  });
}

/// Static points around the vehicle, far enough apart to be told from each other, and what a radar
/// reports of them from the poses of the state, without noise.
class MapScene {
 public:
  explicit MapScene(OdometryState& state) : state_(state) {
    simulation::Random random(3);
    points_ = simulation::scatter(random, 60, 8.0, 60.0, numeric::radians(70.0), 5.0);
    for (Eigen::Vector2d& point : points_) {
      const Eigen::Vector3d now = state.pose_before(kAgeS).pose;
      point = composed_pose(now, {point.x(), point.y(), 0.0}).head<2>();
    }
    pose_ = state.pose_before(kAgeS).pose;
    scan_ = seen_from(pose_);
    for (std::size_t i = 0; i < kMapNodes; ++i) {
      scans_[i] = seen_from(state.node_pose(i));
      insert(i, Eigen::Vector3d::Zero());
    }
  }

  /// Inserts the scan of a node, whose positions moved by (x, y, yaw) in the frame of the node.
  void insert(std::size_t i, const Eigen::Vector3d& shift) {
    map_->insert(i, simulation::targets(scans_[i], kTwoMounts[0]), kTwoMounts[0], shift);
  }
  /// All reports of azimuths a become scale a + offset_rad.
  void report_azimuths(double scale, double offset_rad) {
    const auto report = [&](simulation::Detections& detections) {
      for (Detection& detection : detections) {
        detection.azimuth_rad = scale * detection.azimuth_rad + offset_rad;
      }
    };
    report(scan_);
    for (std::size_t i = 0; i < kMapNodes; ++i) {
      report(scans_[i]);
      insert(i, Eigen::Vector3d::Zero());
    }
  }

  /// The registration at the present state.
  MapMatch match() {
    map_->place(measurement().now_from_node());
    const auto match =
        registration_.solve(simulation::targets(scan_, kTwoMounts[0]), *map_, kTwoMounts[0]);
    REQUIRE(match);
    return *match;
  }
  LinearMeasurement linearise(const MapMatch& match) const {
    return measurement().linearise(match, true);
  }
  [[nodiscard]] LinearMeasurement linearise_without_x(const MapMatch& match) const {
    return measurement().linearise(match, false);
  }
  [[nodiscard]] TargetMap::NodePoses nodes() const { return measurement().now_from_node(); }
  /// Derivative of the measurement (x, y, yaw) by a state.
  Eigen::Vector3d derivative(const LinearMeasurement& linear, int state) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int k = 0; k < linear.states; ++k) {
      const auto i = static_cast<std::size_t>(k);
      sum += linear.state[i] == state ? linear.jacobian[i] : Eigen::Vector3d::Zero();
    }
    return sum;
  }

 private:
  static constexpr double kAgeS = 0.03;

  [[nodiscard]] MapMeasurement measurement() const { return {state_, *map_, 0, kAgeS}; }
  simulation::Detections seen_from(const Eigen::Vector3d& pose) const {
    return simulation::observe_all(points_, pose, 1.0, kTwoMounts[0], {0.1, 0.003, 0.1});
  }

  OdometryState& state_;
  simulation::Points points_;
  Eigen::Vector3d pose_;
  simulation::Detections scan_;
  std::array<simulation::Detections, kMapNodes> scans_;
  std::unique_ptr<TargetMap> map_ = std::make_unique<TargetMap>();
  MapRegistration registration_{0.7};
};

/// A correction may differ from its linearisation by this share: the weights of targets against
/// clutter change with their distance.
constexpr double kLinear = 0.01;

void check_close(const Eigen::Vector2d& actual, const Eigen::Vector2d& expected) {
  CAPTURE(actual.transpose(), expected.transpose());
  CHECK((actual - expected).norm() < kLinear * expected.norm());
}

TEST_CASE("a scan that was taken at the predicted pose needs no correction") {
  const OdometryOptions options;
  OdometryState state = busy_state(options);
  for (int i = 0; i < kErrorStates; ++i) {
    state.gaussian.set_mean(state.error(0, i), 0.0);
  }
  state.gaussian.set_mean(kCommonAzimuthScale, 0.0);
  state.gaussian.set_mean(kCommonYawPerMetre, 0.0);
  state.gaussian.set_mean(kCommonXPerMetre, 0.0);
  MapScene scene(state);
  CHECK(scene.linearise(scene.match()).residual.norm() < 1e-6);
}

TEST_CASE("the Jacobian of the map measurement predicts the correction when poses change") {
  const OdometryOptions options;
  OdometryState state = busy_state(options);
  MapScene scene(state);
  const LinearMeasurement linear = scene.linearise(scene.match());
  // Steps of a few millimetres at the targets, far below their noise.
  const auto change = [&](int which, double step) -> Eigen::Vector3d {
    const double value = state.gaussian.mean(which);
    state.gaussian.set_mean(which, value + step);
    const Eigen::Vector3d above = scene.match().correction;
    state.gaussian.set_mean(which, value - step);
    const Eigen::Vector3d below = scene.match().correction;
    state.gaussian.set_mean(which, value);
    return (below - above) / (2.0 * step);
  };
  const auto derivative = [&](int which) { return scene.derivative(linear, which); };
  // By design y and yaw do not depend on a shift along the path, nor x on anything else.
  const auto y_and_yaw = [](const Eigen::Vector3d& by) -> Eigen::Vector2d { return by.tail<2>(); };
  SECTION("the yaw and the yaw rate of the vehicle") {
    check_close(y_and_yaw(change(kYaw, 1e-4)), y_and_yaw(derivative(kYaw)));
    check_close(y_and_yaw(change(kYawRate, 3e-3)), y_and_yaw(derivative(kYawRate)));
  }
  SECTION("a shift of the vehicle across and along its path") {
    const double yaw = state.pose_before(0.03).pose.z();
    const auto across = [&](const auto& by) -> Eigen::Vector3d {
      return -std::sin(yaw) * by(kX) + std::cos(yaw) * by(kY);
    };
    const auto along = [&](const auto& by) -> Eigen::Vector3d {
      return std::cos(yaw) * by(kX) + std::sin(yaw) * by(kY);
    };
    const auto by_steps = [&](int which) { return change(which, 1e-3); };
    check_close(y_and_yaw(across(by_steps)), y_and_yaw(across(derivative)));
    CHECK(along(derivative).x() == Approx(along(by_steps).x()).epsilon(2.0 * kLinear));
    CHECK(y_and_yaw(along(derivative)).norm() < 1e-12);
    CHECK(std::abs(across(derivative).x()) < 1e-12);
  }
  SECTION("a shift of a node across the path, and its turn about the present pose") {
    const auto k = GENERATE(std::size_t{0}, std::size_t{1}, std::size_t{2});
    const double yaw = state.pose_before(0.03).pose.z();
    const auto of_node = [&](const auto& by) -> std::array<Eigen::Vector3d, 3> {
      const Eigen::Vector3d across =
          -std::sin(yaw) * by(node(k), 1e-3) + std::cos(yaw) * by(node(k) + 1, 1e-3);
      const Eigen::Vector3d along =
          std::cos(yaw) * by(node(k), 1e-3) + std::sin(yaw) * by(node(k) + 1, 1e-3);
      // A turn of the node moves the origin of the present pose along x by its y.
      const Eigen::Vector3d turn = by(node(k) + 2, 1e-4) - scene.nodes()[k].y() * along;
      return {across, turn, along};
    };
    const auto expected = of_node([&](int which, double /*step*/) { return derivative(which); });
    const auto actual = of_node([&](int which, double step) { return change(which, step); });
    check_close(y_and_yaw(actual[0]), y_and_yaw(expected[0]));
    check_close(y_and_yaw(actual[1]), y_and_yaw(expected[1]));
    CHECK(expected[2].x() == Approx(actual[2].x()).epsilon(2.0 * kLinear));
    CHECK(y_and_yaw(expected[2]).norm() < 1e-12);
  }
  SECTION("without x nothing depends on it") {
    const LinearMeasurement without = scene.linearise_without_x(scene.match());
    CHECK(without.residual.x() == 0.0);
    CHECK(without.noise.col(0) == Eigen::Vector3d::UnitX());
    CHECK(without.noise.row(0).transpose() == Eigen::Vector3d::UnitX());
    for (int k = 0; k < without.states; ++k) {
      CHECK(without.jacobian[static_cast<std::size_t>(k)].x() == 0.0);
    }
  }
}

TEST_CASE("the Jacobian of the map measurement predicts the effect of each error of a radar") {
  const OdometryOptions options;
  OdometryState state = busy_state(options);
  for (int i = 0; i < kErrorStates; ++i) {
    state.gaussian.set_mean(state.error(0, i), 0.0);
  }
  state.gaussian.set_mean(kCommonAzimuthScale, 0.0);
  state.gaussian.set_mean(kCommonYawPerMetre, 0.0);
  state.gaussian.set_mean(kCommonXPerMetre, 0.0);
  MapScene scene(state);
  const LinearMeasurement linear = scene.linearise(scene.match());
  const auto check_error = [&](int which, double error) {
    const MapMatch match = scene.match();
    check_close(match.correction.tail<2>(), error * scene.derivative(linear, which).tail<2>());
    // A known error leaves no residual.
    state.gaussian.set_mean(which, error);
    CHECK(scene.linearise(match).residual.tail<2>().norm() <
          kLinear * match.correction.tail<2>().norm());
  };
  SECTION("mount yaw: true minus configured") {
    scene.report_azimuths(1.0, -0.002);
    check_error(state.error(0, kMountYaw), 0.002);
  }
  SECTION("scale of azimuths: true = (1 + error) reported") {
    scene.report_azimuths(1.0 / 1.0002, 0.0);
    const int which = GENERATE(+kCommonAzimuthScale, radar(0) + kAzimuthScale);
    check_error(which, 0.0002);
  }
  SECTION("yaw and lateral error over distance") {
    const double lateral = GENERATE(0.0, 1e-3);
    const double yaw_radpm = lateral > 0.0 ? 0.0 : 1e-5;
    const TargetMap::NodePoses nodes = scene.nodes();
    for (std::size_t i = 0; i < kMapNodes; ++i) {
      // A motion in the frame of the present pose, as one in the frame of the node.
      const double way_m = -nodes[i].x();
      const Eigen::Vector3d moved =
          composed_pose(way_m * Eigen::Vector3d(0.0, lateral, yaw_radpm), nodes[i]);
      scene.insert(i, relative_pose(nodes[i], moved));
    }
    const int yaw_error = GENERATE(+kCommonYawPerMetre, radar(0) + kYawPerMetre);
    const MapMatch match = scene.match();
    double behind_m = 0.0;
    for (std::size_t i = 0; i < kMapNodes; ++i) {
      behind_m -= match.by_node[i](0, 0) * nodes[i].x();
    }
    CHECK(scene.derivative(linear, kCommonXPerMetre).x() ==
          Approx((1.0 / match.x_share - 1.0) * behind_m).epsilon(kLinear));
    check_error(lateral > 0.0 ? state.error(0, kLateralPerMetre) : yaw_error,
                lateral > 0.0 ? lateral : yaw_radpm);
  }
}

TEST_CASE("the Jacobian of the motion model is its derivative, forward and back in time") {
  const OdometryOptions options;
  const OdometryState state = busy_state(options);
  const MotionStep::Vector at = state.gaussian.mean().head<kMotionStates>();
  const double dt_s = GENERATE(0.07, 0.0, -0.05);
  const MotionStep step = moved(at, dt_s, options);
  const auto expected = numeric::central_differences(
      at, 1e-6, [&](const MotionStep::Vector& x) { return moved(x, dt_s, options).state; });
  CHECK((step.jacobian - expected).cwiseAbs().maxCoeff() < 1e-7);
}

TEST_CASE("the motion model follows a circle at constant yaw rate") {
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

TEST_CASE("of a vehicle of unknown motion the way across is as uncertain as drawn motions say") {
  OdometryOptions options;
  options.acceleration.std = 1e-3;
  options.yaw_acceleration.std = 1e-3;
  const double speed_mps = GENERATE(0.0, 5.0);
  VehicleEstimate start{MotionStep::Vector::Unit(kSpeed) * speed_mps, MotionStep::Matrix::Zero()};
  const double speed_std_mps = 4.0;
  const double yaw_rate_std_radps = 0.2;
  start.covariance(kSpeed, kSpeed) = speed_std_mps * speed_std_mps;
  start.covariance(kYawRate, kYawRate) = yaw_rate_std_radps * yaw_rate_std_radps;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const double time_s = 1.5;
  double sum = 0.0;
  constexpr int kDraws = 2000;
  for (int i = 0; i < kDraws; ++i) {
    VehicleEstimate drawn{start.mean, MotionStep::Matrix::Zero()};
    drawn.mean(kSpeed) += speed_std_mps * normal(random);
    drawn.mean(kYawRate) += yaw_rate_std_radps * normal(random);
    const double y_m = drawn.predicted(time_s, options).mean(kY);
    sum += y_m * y_m;
  }
  const double std_m = std::sqrt(start.predicted(time_s, options).covariance(kY, kY));
  CHECK(std_m == Approx(std::sqrt(sum / kDraws)).epsilon(0.15));
}

TEST_CASE("process noise does not depend on the step length") {
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
    CHECK(noise(i, i) == Approx(whole.noise(i, i)).epsilon(1e-9));
  }
  CHECK(rate_variance(options.acceleration, 0.1) == Approx(whole.noise(kSpeed, kSpeed)));
  CHECK(rate_variance(yaw_acceleration_at(8.0, options), 0.1) ==
        Approx(whole.noise(kYawRate, kYawRate)));
}

TEST_CASE("the covariance of a pose stays definite if the speed is unknown and its mean 0") {
  const OdometryOptions options;
  VehicleEstimate vehicle{MotionStep::Vector::Zero(), MotionStep::Matrix::Zero()};
  vehicle.mean(kSlip) = 0.003;
  vehicle.covariance(kSpeed, kSpeed) = 900.0;
  vehicle.covariance(kYawRate, kYawRate) = 0.09;
  vehicle.covariance(kSlip, kSlip) = 1e-4;
  const double dt_s = GENERATE(1e-5, 0.01, 0.1);
  CAPTURE(dt_s);
  const Eigen::Matrix2d position =
      vehicle.predicted(dt_s, options).covariance.topLeftCorner<2, 2>();
  CHECK(position.determinant() > 0.5e-8 * dt_s * position(0, 0));
}

TEST_CASE("the Jacobian of a relative pose is its derivative") {
  using Poses = Eigen::Matrix<double, 6, 1>;
  const Poses at = (Poses() << 1.0, -2.0, 0.8, 4.0, 1.0, 1.1).finished();
  const Eigen::Vector3d relative = relative_pose(at.head<3>(), at.tail<3>());
  const auto expected = numeric::central_differences(
      at, 1e-6,
      [](const Poses& x) -> Eigen::Vector3d { return relative_pose(x.head<3>(), x.tail<3>()); });
  CHECK((relative_pose_jacobian(at.head<3>(), relative) - expected).norm() < 1e-7);
  CHECK((composed_pose(at.head<3>(), relative) - at.tail<3>()).norm() < 1e-12);
}

TEST_CASE("a new anchor changes no relative pose and no covariance of one") {
  const OdometryOptions options;
  OdometryState state(options, kTwoMounts);
  state.start();
  state.gaussian.set(kSpeed, 8.0, 0.1);
  state.gaussian.set(kYawRate, 0.3, 0.01);
  state.advance_to(100'000);
  state.clone_node(2, 0.02);
  state.advance_to(800'000);
  state.clone_node(3, 0.03);
  state.advance_to(900'000);
  const int from = node(2);
  const int to = node(3);
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

TEST_CASE("sigma of a predicted pose does not depend on the length of the steps") {
  const OdometryOptions options;
  VehicleEstimate known;
  known.mean.setZero();
  known.mean(kSpeed) = 10.0;
  known.mean(kYawRate) = GENERATE(0.0, 0.4);
  known.covariance.setZero();
  known.covariance(kAcceleration, kAcceleration) = 0.1;
  const VehicleEstimate at_once = known.predicted(kMaxMotionStepS, options);
  VehicleEstimate in_steps = known;
  constexpr int kSteps = 100;
  for (int i = 0; i < kSteps; ++i) {
    in_steps = in_steps.predicted(kMaxMotionStepS / kSteps, options);
  }
  for (const int i : {kX, kYaw}) {
    CAPTURE(i);
    CHECK(std::sqrt(at_once.covariance(i, i)) ==
          Approx(std::sqrt(in_steps.covariance(i, i))).epsilon(0.05));
  }
}

}  // namespace
}  // namespace cremed
