// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/static_targets.hpp"
#include "test/estimator/numeric.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using namespace state_layout;

const std::vector<Pose2> kFrontAndAslant{{3.4, 0.3, 0.0}, {-0.6, 0.6, 2.3}};
/// Slip and mount yaw are linearised: 0.02^2 / 2 of 10 m/s.
constexpr double kLinearMps = 0.005;

OdometryOptions options(double static_doppler_mps) {
  OdometryOptions options;
  options.static_doppler_mps = static_doppler_mps;
  return options;
}

/// What the radars of a vehicle report of points around it, without noise.
class StaticScene {
 public:
  explicit StaticScene(double static_doppler_mps = kLinearMps)
      : state_(options(static_doppler_mps), kFrontAndAslant) {
    state_.start();
    state_.gaussian.set_mean(kSlipPerAcceleration, 0.0);
    state_.gaussian.set_mean(kSpeed, 10.0);
    simulation::Random random(1);
    points_ = simulation::scatter(random, 60, 5.0, 80.0, numeric::radians(180.0), 0.5);
  }

  GaussianState& state() { return state_.gaussian; }
  [[nodiscard]] int error(std::size_t radar, int which) const { return state_.error(radar, which); }
  /// Static targets of a scan at a velocity of (m/s forward, m/s left, rad/s).
  [[nodiscard]] TargetSet see(std::size_t radar, const Eigen::Vector3d& velocity,
                              double mount_yaw_error_rad = 0.0) const {
    Pose2 mount = kFrontAndAslant[radar];
    mount.yaw_rad += mount_yaw_error_rad;
    return simulation::targets(simulation::observe_all(points_, velocity, 1.0, mount, {}),
                               kFrontAndAslant[radar]);
  }
  [[nodiscard]] TargetSet select(std::size_t radar, const TargetSet& targets,
                                 double age_s = 0.0) const {
    TargetSet result;
    result.add(Target());
    select_static(state_, radar, age_s, targets, result);
    return result;
  }
  /// Share of a scan's targets that are taken as static.
  [[nodiscard]] double share(std::size_t radar, const TargetSet& targets,
                             double age_s = 0.0) const {
    return static_cast<double>(select(radar, targets, age_s).size()) /
           static_cast<double>(targets.size());
  }

 private:
  OdometryState state_;
  simulation::Points points_;
};

TEST_CASE("all static targets are taken, in a turn too, and the result is replaced") {
  StaticScene scene;
  const auto radar = GENERATE(std::size_t{0}, std::size_t{1});
  scene.state().set_mean(kYawRate, 0.4);
  const TargetSet targets = scene.see(radar, {10.0, 0.0, 0.4});
  const TargetSet selected = scene.select(radar, targets);
  REQUIRE(selected.size() == targets.size());
  CHECK(selected[0].x_m == targets[0].x_m);
  CHECK(scene.share(radar, scene.see(radar, {10.0, 0.0, 0.0})) < 0.2);
}

TEST_CASE("targets that move by more than the threshold along the line of sight are left out") {
  const double threshold_mps = 0.5;
  const StaticScene scene(threshold_mps);
  TargetSet targets;
  const double moving_mps = GENERATE(-8.0, -0.51, 0.51, 8.0);
  for (const Target& target : scene.see(0, {10.0, 0.0, 0.0})) {
    Target moving = target;
    moving.doppler_mps += moving_mps;
    targets.add(moving);
    moving.doppler_mps = target.doppler_mps + std::copysign(0.49, moving_mps);
    targets.add(moving);
  }
  const TargetSet selected = scene.select(0, targets);
  REQUIRE(2 * selected.size() == targets.size());
  for (std::size_t i = 0; i < selected.size(); ++i) {
    CHECK(selected[i].doppler_mps == targets[2 * i + 1].doppler_mps);
  }
}

TEST_CASE("slip and its change with the lateral acceleration are expected") {
  StaticScene scene;
  const auto radar = GENERATE(std::size_t{0}, std::size_t{1});
  scene.state().set_mean(kYawRate, 0.4);
  SECTION("slip") {
    const TargetSet targets = scene.see(radar, {10.0, 10.0 * 0.02, 0.4});
    CHECK(scene.share(radar, targets) < 0.2);
    scene.state().set_mean(kSlip, 0.02);
    CHECK(scene.share(radar, targets) == 1.0);
  }
  SECTION("per acceleration: outwards in the turn") {
    const TargetSet targets = scene.see(radar, {10.0, -0.005 * 10.0 * 10.0 * 0.4, 0.4});
    CHECK(scene.share(radar, targets) < 0.2);
    scene.state().set_mean(kSlipPerAcceleration, 0.005);
    CHECK(scene.share(radar, targets) == 1.0);
  }
}

TEST_CASE("the yaw error of the radar's own mount is expected") {
  StaticScene scene;
  const auto radar = GENERATE(std::size_t{0}, std::size_t{1});
  const TargetSet targets = scene.see(radar, {10.0, 0.0, 0.0}, 0.02);
  CHECK(scene.share(radar, targets) < 0.2);
  scene.state().set_mean(scene.error(1 - radar, kMountYaw), 0.02);
  CHECK(scene.share(radar, targets) < 0.2);
  scene.state().set_mean(scene.error(radar, kMountYaw), 0.02);
  CHECK(scene.share(radar, targets) == 1.0);
}

TEST_CASE("an older scan is compared with the motion at its time") {
  StaticScene scene;
  scene.state().set_mean(kAcceleration, -3.0);
  scene.state().set_mean(kYawRate, 0.2);
  scene.state().set_mean(kYawAcceleration, 1.0);
  const TargetSet targets = scene.see(0, {10.3, 0.0, 0.1});
  CHECK(scene.share(0, targets, 0.1) == 1.0);
  CHECK(scene.share(0, targets) < 0.2);
}

TEST_CASE("at rest all that stands is taken, and nothing that passes") {
  StaticScene scene(0.5);
  scene.state().set_mean(kSpeed, 0.0);
  CHECK(scene.share(0, scene.see(0, Eigen::Vector3d::Zero())) == 1.0);
  // A world that passes at 10 m/s, but for what is abeam.
  CHECK(scene.share(0, scene.see(0, {10.0, 0.0, 0.0})) < 0.1);
}

}  // namespace
}  // namespace cremed
