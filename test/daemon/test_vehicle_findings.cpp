// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/report/vehicle_findings.hpp"

namespace cremed {
namespace {

VehicleConfiguration on_can0() {
  VehicleConfiguration vehicle;
  vehicle.interface = "can0";
  return vehicle;
}

VehicleStatus healthy_vehicle() {
  VehicleStatus status;
  status.odometry.is_used = true;
  status.odometry.readings = 5000;
  status.odometry.measurements_used = 1000;
  status.odometry.scale = 0.004;
  status.odometry.scale_std = 0.002;
  status.odometry.bias_radps = -0.0004;
  status.odometry.bias_std_radps = 0.0003;
  return status;
}

std::vector<Finding> findings_of(const VehicleStatus& status, bool with_past = false,
                                 VehicleSignal signal = VehicleSignal::yaw_rate) {
  return vehicle_findings(on_can0(), signal, status, with_past);
}

std::string only_finding(const VehicleStatus& status, bool with_past = false,
                         VehicleSignal signal = VehicleSignal::yaw_rate) {
  const auto findings = findings_of(status, with_past, signal);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].severity == Severity::warning);
  CHECK_FALSE(findings[0].remedy.empty());
  return findings[0].what;
}

TEST_CASE("a sound signal has a summary and no finding") {
  const VehicleStatus status = healthy_vehicle();
  CHECK(findings_of(status, true).empty());
  CHECK(signal_state(status) == SignalState::ok);
  CHECK(vehicle_summary(VehicleSignal::yaw_rate, status) ==
        "5000 frames, 1000 measurements, scale +0.40 +- 0.20 %, bias -0.023 +- 0.017 deg/s");
  CHECK(vehicle_summary(VehicleSignal::speed, status) ==
        "5000 frames, 1000 measurements, scale +0.40 +- 0.20 %");
}

TEST_CASE("a lost signal is told from one that never was") {
  VehicleStatus status = healthy_vehicle();
  status.odometry.is_lost = true;
  status.odometry.times_lost = 2;
  CHECK(only_finding(status) == "lost: no frame 0x301 on can0");
  CHECK(signal_state(status) == SignalState::lost);
  status.odometry.readings = 0;
  CHECK(only_finding(status, false, VehicleSignal::speed) == "no frame 0x300 on can0");
  status = healthy_vehicle();
  status.odometry.times_lost = 2;
  CHECK(findings_of(status).empty());
  CHECK(only_finding(status, true) == "lost: no frame 0x301 on can0 for a while, 2 times");
}

TEST_CASE("a frozen signal and one that contradicts are named, with what the radars see") {
  VehicleStatus status = healthy_vehicle();
  status.odometry.is_frozen = true;
  CHECK_THAT(only_finding(status), Catch::StartsWith("frozen: 0x301 repeats one value"));
  status = healthy_vehicle();
  status.odometry.is_left_out = true;
  status.odometry.times_left_out = 1;
  status.odometry.nis = 20.0;
  const std::string head = "excluded from the odometry: 0x301 contradicts the radars";
  CHECK(only_finding(status) == head + " (normalised innovation squared 20.0, 1 expected)");
  CHECK(signal_state(status) == SignalState::excluded);
  status.odometry.seen_scale = 0.2;
  status.odometry.seen_delay_s = 0.3;
  status.odometry.seen_offset = 0.017453;
  status.odometry.fault = SignalFault::scale;
  CHECK(only_finding(status) == head + ": it is 25.0 % too large");
  status.odometry.seen_scale = -0.25;
  CHECK(only_finding(status) == head + ": it is 20.0 % too small");
  status.odometry.seen_scale = 1.0 - 1.0 / 57.3;  // A yaw rate in degrees, taken for radians.
  CHECK(only_finding(status) == head + ": it is more than ten times too large");
  status.odometry.seen_scale = 2.0;
  CHECK(only_finding(status) == head + ": its sign is wrong");
  status.odometry.fault = SignalFault::delay;
  CHECK(only_finding(status) == head + ": it comes 0.30 s later than configured");
  status.odometry.fault = SignalFault::offset;
  CHECK(only_finding(status) == head + ": its offset is +1.00 deg/s");
}

TEST_CASE("frames that cannot be read are counted, after the fault that they cause") {
  VehicleStatus status = healthy_vehicle();
  status.bad_frames = 3;
  CHECK_THAT(only_finding(status), Catch::StartsWith("3 frames 0x301 cannot be read"));
  status.odometry.is_lost = true;
  CHECK(findings_of(status).front().what == "lost: no readable frame 0x301 on can0");
  status.odometry.readings = 0;
  CHECK(findings_of(status).front().what == "no readable frame 0x301 on can0");
}

}  // namespace
}  // namespace cremed
