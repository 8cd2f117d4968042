// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "cremed/can_decoders/vehicle_reading.hpp"
#include "test/can_decoders/ars408_rows.hpp"
#include "test/can_decoders/hex_frame.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

void check_value(VehicleSignal signal, CanFrame frame, double expected) {
  frame.stamp_us = 1'234'567;
  const auto reading = decode_vehicle_reading(signal, frame);
  REQUIRE(reading);
  CHECK(reading->value == Approx(expected).margin(1e-12));
  CHECK(reading->signal == signal);
  CHECK(reading->stamp_us == 1'234'567);
}

bool is_refused(VehicleSignal signal, const CanFrame& frame) {
  return !decode_vehicle_reading(signal, frame);
}

}  // namespace

TEST_CASE("Speed: magnitude with direction, of any sensor's identifier") {
  check_value(VehicleSignal::speed, hex_frame("300#4320"), 16.0);
  check_value(VehicleSignal::speed, hex_frame("330#8032"), -1.0);
  check_value(VehicleSignal::speed, hex_frame("300#0000"), 0.0);
  check_value(VehicleSignal::speed, hex_frame("300#5FFF"), 163.82);
  // Longer frames of gateways.
  check_value(VehicleSignal::speed, hex_frame("300#4320FFFFFFFFFFFF"), 16.0);
}

TEST_CASE("Yaw rate of the vehicle: counter-clockwise is positive") {
  check_value(VehicleSignal::yaw_rate, hex_frame("301#8000"), 0.0);
  check_value(VehicleSignal::yaw_rate, hex_frame("301#83E8"), deg(10.0));
  check_value(VehicleSignal::yaw_rate, hex_frame("301#0000"), deg(-327.68));
}

TEST_CASE("What the daemon encodes for a sensor reads as it was, within half a step") {
  for (double value = -30.0; value <= 30.0; value += 0.3333) {
    const auto speed = decode_vehicle_reading(VehicleSignal::speed, encode_ars408_speed(2, value));
    REQUIRE(speed);
    CHECK(std::abs(speed->value - value) <= 0.5 * kVehicleSpeedStepMps + 1e-9);
    const auto yaw_rate =
        decode_vehicle_reading(VehicleSignal::yaw_rate, encode_ars408_yaw_rate(2, deg(value)));
    REQUIRE(yaw_rate);
    CHECK(std::abs(yaw_rate->value - deg(value)) <= deg(0.5 * kVehicleYawRateStepDegps) + 1e-9);
  }
}

TEST_CASE("Frames that say nothing or contradict themselves are refused") {
  CHECK(is_refused(VehicleSignal::speed, hex_frame("300#0001")));  // Moves at standstill.
  CHECK(is_refused(VehicleSignal::speed, hex_frame("300#C320")));  // No such direction.
  CHECK(is_refused(VehicleSignal::speed, hex_frame("300#43")));
  CHECK(is_refused(VehicleSignal::yaw_rate, hex_frame("301#")));
  CanFrame remote = hex_frame("301#8000");
  remote.remote = true;
  CHECK(is_refused(VehicleSignal::yaw_rate, remote));
}
