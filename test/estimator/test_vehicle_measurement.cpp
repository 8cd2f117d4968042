// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <catch2/catch.hpp>

#include "cremed/estimator/fusion/measurement/vehicle_measurement.hpp"
#include "test/estimator/simulation.hpp"

namespace cremed {
namespace {

using namespace state_layout;
using simulation::kTwoMounts;

OdometryOptions with_vehicle() {
  OdometryOptions options;
  options.vehicle.speed.is_used = true;
  options.vehicle.yaw_rate.is_used = true;
  return options;
}

/// In a turn, with nothing zero.
OdometryState turning_state(double speed_mps) {
  OdometryState state(with_vehicle(), kTwoMounts);
  state.start();
  state.gaussian.set_mean(kSpeed, speed_mps);
  state.gaussian.set_mean(kAcceleration, -1.2);
  state.gaussian.set_mean(kYawRate, 0.4);
  state.gaussian.set_mean(kYawAcceleration, 0.3);
  state.gaussian.set_mean(state.vehicle_error(kSpeedScale), 0.013);
  state.gaussian.set_mean(state.vehicle_error(kYawRateGain), -0.008);
  state.gaussian.set_mean(state.vehicle_error(kYawRateBias), 0.002);
  return state;
}

double noise_of(const OdometryState& state, VehicleSignal signal, double interval_s, double value,
                double age_s = 0.0) {
  return VehicleMeasurement{state, signal, age_s, interval_s}.linearise(value).noise(0, 0);
}

TEST_CASE("the Jacobian of a vehicle measurement is the derivative of its residual") {
  OdometryState state = turning_state(8.0);
  const auto signal = GENERATE(VehicleSignal::speed, VehicleSignal::yaw_rate);
  const double age_s = GENERATE(-0.01, 0.0, 0.05);
  const VehicleMeasurement measure{state, signal, age_s, 0.05};
  const LinearMeasurement measurement = measure.linearise(0.5);
  Eigen::VectorXd jacobian = Eigen::VectorXd::Zero(state.gaussian.size());
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    jacobian(measurement.state[i]) += measurement.jacobian[i].x();
    CHECK(measurement.jacobian[i].y() == 0.0);
  }
  constexpr double kStep = 1e-6;
  for (int i = 0; i < state.gaussian.size(); ++i) {
    const double value = state.gaussian.mean(i);
    state.gaussian.set_mean(i, value + kStep);
    const double above = measure.linearise(0.5).residual.x();
    state.gaussian.set_mean(i, value - kStep);
    const double below = measure.linearise(0.5).residual.x();
    state.gaussian.set_mean(i, value);
    CAPTURE(i);
    CHECK(jacobian(i) == Approx((below - above) / (2.0 * kStep)).margin(1e-7));
  }
}

TEST_CASE("a measurement is of the motion at its time, with scale and bias") {
  const OdometryState state = turning_state(8.0);
  const auto residual = [&](VehicleSignal signal, double age_s, double value) {
    return VehicleMeasurement{state, signal, age_s, 0.05}.linearise(value).residual;
  };
  CHECK(residual(VehicleSignal::speed, 0.0, 8.0 * 1.013).norm() < 1e-12);
  CHECK(residual(VehicleSignal::speed, 0.1, 8.12 * 1.013).norm() < 1e-12);
  CHECK(residual(VehicleSignal::yaw_rate, 0.0, 0.4 * 0.992 + 0.002).norm() < 1e-12);
  CHECK(residual(VehicleSignal::yaw_rate, 0.1, 0.37 * 0.992 + 0.002).norm() < 1e-12);
}

TEST_CASE("a fault of a signal is an offset, a scale or a delay of the motion beyond its noise") {
  OdometryState state = turning_state(8.0);
  const auto signal = GENERATE(VehicleSignal::speed, VehicleSignal::yaw_rate);
  const bool is_speed = signal == VehicleSignal::speed;
  const auto faults = [&] {
    return VehicleMeasurement{state, signal, 0.0, 0.05}.linearise(0.5).by_faults;
  };
  for (const int i : {kSpeed, kAcceleration, kYawRate, kYawAcceleration}) {
    state.gaussian.set(i, state.gaussian.mean(i), 0.01);
  }
  LinearMeasurement::ByFaults expected = LinearMeasurement::ByFaults::Zero();
  expected.row(0).segment<3>(OdometryState::fault_of(signal)) =
      is_speed ? Eigen::RowVector3d(1.0, 8.0, 1.2) : Eigen::RowVector3d(1.0, 0.4, -0.3);
  CHECK((faults() - expected).norm() < 0.05);

  for (const int i : {kSpeed, kAcceleration, kYawRate, kYawAcceleration}) {
    state.gaussian.set(i, 0.099, 0.01);
  }
  expected.row(0).segment<3>(OdometryState::fault_of(signal)) << 1.0, 0.0, 0.0;
  CHECK(faults() == expected);
}

TEST_CASE("at standstill the speed says nothing of its scale") {
  const OdometryState state = turning_state(0.0);
  const LinearMeasurement measurement =
      VehicleMeasurement{state, VehicleSignal::speed, 0.0, 0.05}.linearise(0.0);
  CHECK(measurement.residual.x() == 0.0);
  for (int k = 0; k < measurement.states; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (measurement.state[i] == state.vehicle_error(kSpeedScale)) {
      CHECK(measurement.jacobian[i].x() == 0.0);
    }
  }
}

TEST_CASE("measurements at a higher rate are not believed more, as their error is the same") {
  OdometryState state = turning_state(8.0);
  state.gaussian.set_mean(kAcceleration, 0.0);
  state.gaussian.set_mean(kYawAcceleration, 0.0);
  for (const VehicleSignal signal : {VehicleSignal::speed, VehicleSignal::yaw_rate}) {
    // The variance of a mean over a second of n measurements is noise / n.
    const double at_100_hz = noise_of(state, signal, 0.01, 8.0) / 100.0;
    const double at_20_hz = noise_of(state, signal, 0.05, 8.0) / 20.0;
    CHECK(at_100_hz == Approx(at_20_hz).epsilon(0.05));
    // Once in a minute it is the error of one value.
    CHECK(noise_of(state, signal, 60.0, 8.0) ==
          Approx(std::pow(with_vehicle().vehicle.of(signal).error.std, 2)).epsilon(0.05));
  }
}

TEST_CASE("noise grows with acceleration by the delay's error, with age, and for a crawling car") {
  OdometryState state = turning_state(8.0);
  for (const VehicleSignal signal : {VehicleSignal::speed, VehicleSignal::yaw_rate}) {
    const double braking = noise_of(state, signal, 0.05, 8.0);
    CHECK(noise_of(state, signal, 0.05, 8.0, 0.1) > braking);
    OdometryState steady = state;
    steady.gaussian.set_mean(kAcceleration, 0.0);
    steady.gaussian.set_mean(kYawAcceleration, 0.0);
    CHECK(noise_of(steady, signal, 0.05, 8.0) < braking);
  }
  CHECK(noise_of(state, VehicleSignal::speed, 0.05, 0.4) >
        noise_of(state, VehicleSignal::speed, 0.05, 4.0) + 0.009);
}

TEST_CASE("without signals of the vehicle the state has no places for them") {
  const OdometryState without(OdometryOptions(), kTwoMounts);
  const OdometryState with(with_vehicle(), kTwoMounts);
  CHECK(without.gaussian.size() == size(2));
  CHECK(with.gaussian.size() == size(2) + kVehicleStates);
}

}  // namespace
}  // namespace cremed
