// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "test/tools/doctor_bench.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

Configuration with_vehicle() {
  Configuration configuration = demo_configuration();
  configuration.vehicle.interface = "can0";
  configuration.odometry.filter.vehicle.speed.is_used = true;
  configuration.odometry.filter.vehicle.yaw_rate.is_used = true;
  return configuration;
}

/// Adds a frame of the vehicle after each frame of a radar's bus.
Recording with_frames(Recording traffic, const CanFrame& frame) {
  Recording result;
  for (const BusFrame& entry : traffic) {
    result.push_back(entry);
    if (entry.interface == "can0") {
      result.push_back({"can0", frame});
      result.back().frame.stamp_us = entry.frame.stamp_us;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("A vehicle bus that lacks a signal is found, with its name") {
  const Configuration configuration = with_vehicle();
  const Recording silent = recording_of(configuration.radars);
  const auto findings = diagnose(configuration, observe(configuration, silent));
  CHECK_THAT(all_text(findings),
             Catch::Contains("vehicle speed: no frame 0x300 on can0; check its sender"));
  CHECK_THAT(all_text(findings), Catch::Contains("vehicle yaw rate: no frame 0x301 on can0"));
  const auto heard = diagnose(
      configuration, observe(configuration, with_frames(silent, encode_ars408_yaw_rate(0, 0.1))));
  CHECK_THAT(all_text(heard), Catch::Contains("vehicle speed: no frame 0x300"));
  CHECK_THAT(all_text(heard), !Catch::Contains("no frame 0x301"));
}

TEST_CASE("Frames with another layout are found, and nothing is without [vehicle]") {
  const Configuration configuration = with_vehicle();
  CanFrame foreign = encode_ars408_speed(0, 0.0);
  foreign.data[1] = 7;  // A speed at standstill.
  const Recording traffic = with_frames(recording_of(configuration.radars), foreign);
  CHECK_THAT(all_text(diagnose(configuration, observe(configuration, traffic))),
             Catch::Contains("frames 0x300 cannot be read"));
  const Configuration without = demo_configuration();
  CHECK_THAT(all_text(diagnose(without, observe(without, traffic))), !Catch::Contains("vehicle"));
}
