// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "tools/eval/calibrate/sensor_velocity.hpp"

namespace cremed {
namespace {

Target target_at(double azimuth_rad, double doppler_mps) {
  Target target;
  target.bearing_rad = azimuth_rad;
  target.cos_bearing = std::cos(azimuth_rad);
  target.sin_bearing = std::sin(azimuth_rad);
  target.bearing_std_rad = 0.01;
  target.doppler_mps = doppler_mps;
  target.doppler_std_mps = 0.1;
  return target;
}

double doppler_of(double azimuth_rad, const DopplerState& state) {
  const double bearing_rad = (1.0 + state[3]) * azimuth_rad;
  return -state[0] * std::cos(bearing_rad) - state[1] * std::sin(bearing_rad) + state[2];
}

RecordedScan scan_of(std::vector<Target> targets, double told_yaw_rate_radps = 0.0) {
  return {0, std::move(targets), told_yaw_rate_radps};
}

std::vector<Target> fan(int count, const DopplerState& state) {
  std::vector<Target> targets;
  for (int i = 0; i < count; ++i) {
    const double azimuth_rad = -1.0 + 2.0 * i / (count - 1);
    targets.push_back(target_at(azimuth_rad, doppler_of(azimuth_rad, state)));
  }
  return targets;
}

TEST_CASE("the velocity that most targets agree on is that of the standing ones") {
  const auto state =
      GENERATE(DopplerState(10.0, 0.5, 0.0, 0.0, 0.0), DopplerState(-0.3, 8.0, 0.0, 0.0, 0.0),
               DopplerState(0.0, 0.0, 0.0, 0.0, 0.0));
  std::vector<Target> targets = fan(20, state);
  for (const double azimuth_rad : {-0.7, -0.1, 0.2, 0.5, 0.9}) {
    targets.push_back(target_at(azimuth_rad, 13.0 + azimuth_rad));
  }
  const auto found = agreed_velocity(targets);
  REQUIRE(found);
  CHECK((*found - state).norm() < 1e-9);
  CHECK(static_part(scan_of(targets), *found).targets.size() == 20);
}

TEST_CASE("targets that cannot tell a velocity tell none") {
  const DopplerState state(10.0, 0.0, 0.0, 0.0, 0.0);
  CHECK_FALSE(agreed_velocity(fan(5, state)));
  CHECK_FALSE(agreed_velocity(std::vector<Target>(30, target_at(0.4, -9.0))));
}

TEST_CASE("the equations of a scan have its state for solution, and its derivative") {
  const DopplerState state(9.0, -2.0, 0.3, 0.01, 0.0);
  const auto targets = fan(30, state);
  const DopplerEquations equations = doppler_equations(scan_of(targets), state, {});
  const DopplerState solution = equations.root.fullPivHouseholderQr().solve(equations.measured);
  CHECK((solution - state).norm() < 0.01);  // e is linearised
  for (const Target& target : targets) {
    for (int i = 0; i < 4; ++i) {
      const DopplerState step = 1e-6 * DopplerState::Unit(i);
      const DopplerState flat(state[0], state[1], state[2], 0.0, 0.0);
      const double slope = (doppler_of(target.bearing_rad, flat + step) -
                            doppler_of(target.bearing_rad, flat - step)) /
                           2e-6;
      CHECK(doppler_row(target, flat, 0.0)[i] == Approx(slope).margin(1e-6));
    }
  }
}

TEST_CASE("few targets leave directions open and say nothing of them") {
  const DopplerState state(7.0, 0.0, 0.0, 0.0, 0.0);
  const DopplerEquations equations = doppler_equations(scan_of({target_at(0.0, -7.0)}), state, {});
  const DopplerMatrix information = equations.root.transpose() * equations.root;
  CHECK(information(0, 0) == Approx(100.0));
  CHECK(information(1, 1) == Approx(0.0).margin(1e-9));
  CHECK((equations.root * DopplerState(7.0, 5.0, 0.0, 0.0, 0.0) - equations.measured).norm() <
        1e-9);
}

TEST_CASE("a rotation lead shows by range and yaw rate, where the sensor is told one") {
  const double told_radps = GENERATE(0.0, 0.3);
  const DopplerState state(9.0, 0.0, 0.1, 0.0, 0.02);
  std::vector<Target> targets = fan(30, state);
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const double range_m = 5.0 + static_cast<double>(37 * i % 60);
    targets[i].x_m = range_m * targets[i].cos_bearing;
    targets[i].y_m = range_m * targets[i].sin_bearing;
    targets[i].doppler_mps += state[4] * told_radps * told_radps * range_m;
  }
  const DopplerEquations equations = doppler_equations(scan_of(targets, told_radps), state, {});
  const DopplerState found = equations.root.fullPivHouseholderQr().solve(equations.measured);
  CHECK((found - state).head<4>().norm() < 1e-6);
  CHECK(found[4] == Approx(told_radps > 0.0 ? 0.02 : 0.0).margin(1e-6));
}

TEST_CASE("errors that all targets share do not average out") {
  const DopplerState state(8.0, 0.0, 0.0, 0.0, 0.0);
  const DopplerNoise noise{1.0, 0.0, 0.05, 0.03};
  const RecordedScan scan = scan_of(fan(200, state));
  DopplerNoise alone = noise;
  alone.shared_offset_std_mps = alone.shared_velocity_std_mps = 0.0;
  const auto information = [&](const DopplerNoise& of) {
    const DopplerMatrix root = doppler_equations(scan, state, of).root;
    return Eigen::Matrix3d((root.transpose() * root).topLeftCorner<3, 3>());
  };
  const Eigen::Matrix3d added = information(noise).inverse() - information(alone).inverse();
  const Eigen::Vector3d shared(0.03 * 0.03, 0.03 * 0.03, 0.05 * 0.05);
  CHECK((added - Eigen::Matrix3d(shared.asDiagonal())).norm() < 1e-9);
}

}  // namespace
}  // namespace cremed
