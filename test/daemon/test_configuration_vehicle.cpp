// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "daemon/configuration/configuration_summary.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "test/daemon/configuration_texts.hpp"

namespace cremed {
namespace {

Configuration parse_vehicle(const std::string& vehicle) {
  return parse_configuration(kArs408 + vehicle, "test.toml");
}

TEST_CASE("the vehicle's bus is off unless it has an interface") {
  for (const char* text :
       {"", "[vehicle]\n", "[vehicle]\ninterface = \"off\"\n", "[vehicle]\nspeed = \"0x310\"\n"}) {
    const Configuration configuration = parse_vehicle(text);
    CHECK(configuration.vehicle.interface.empty());
    CHECK_FALSE(configuration.odometry.filter.vehicle.is_used());
    CHECK(interface_names(configuration) == std::vector<std::string>{"can0"});
    CHECK_FALSE(ids_on(0, configuration)[0x300]);
    CHECK(configuration_summary(configuration).find("vehicle") == std::string::npos);
  }
}

TEST_CASE("on a radar's bus its identifiers are received beside the radar's") {
  const Configuration configuration = parse_vehicle("[vehicle]\ninterface = \"can0\"\n");
  CHECK(configuration.odometry.filter.vehicle.speed.is_used);
  CHECK(configuration.odometry.filter.vehicle.yaw_rate.is_used);
  CHECK(interface_names(configuration) == std::vector<std::string>{"can0"});
  CHECK(interfaces_of(configuration).of_vehicle == 0);
  CHECK(ids_on(0, configuration)[0x300]);
  CHECK(ids_on(0, configuration)[0x301]);
  CHECK(ids_on(0, configuration)[0x60A]);
  CHECK_THAT(configuration_summary(configuration),
             Catch::Contains("vehicle bus: speed (0x300), yaw rate (0x301) on can0\n"));
}

TEST_CASE("a bus of its own comes after the radars'") {
  const Configuration configuration = parse_vehicle(
      "[vehicle]\ninterface = \"can7\"\nspeed = \"off\"\nyaw_rate = \"0x321\"\n"
      "yaw_rate_delay_s = 0.05\nyaw_rate_bias_std_radps = 0.01\n");
  const VehicleOptions& options = configuration.odometry.filter.vehicle;
  CHECK_FALSE(options.speed.is_used);
  CHECK(options.yaw_rate.is_used);
  CHECK(options.yaw_rate.delay_s == 0.05);
  CHECK(options.yaw_rate_bias_std_radps == 0.01);
  CHECK(interface_names(configuration) == std::vector<std::string>{"can0", "can7"});
  CHECK(interfaces_of(configuration).of_vehicle == 1);
  CHECK(ids_on(1, configuration) == IdSet().set(0x321));
  CHECK_FALSE(ids_on(0, configuration)[0x321]);
}

TEST_CASE("what cannot work is refused, our own feedback above all") {
  const std::string on = "[vehicle]\ninterface = \"can0\"\n";
  const std::string id = "a CAN identifier in quotes, \"0x0\" to \"0x7FF\", or \"off\"";
  check_refused({
      {kArs408 + "motion_feedback = true\n" + on, 8, "vehicle.interface",
       "is to be heard, but cremed itself sends speed and yaw rate to radar \"front\"",
       "motion_feedback = false"},
      {kArs408 + "motion_feedback = true\n[vehicle]\ninterface = \"can5\"\n", 8,
       "vehicle.interface", "is to be heard, but cremed itself sends", "must be \"off\""},
      {kArs408 + on + "[odometry]\nenabled = false\n", 7, "vehicle.interface",
       "is to be heard, but odometry.enabled = false", "must be \"off\""},
      {kArs408 + on + "speed = \"off\"\nyaw_rate = \"off\"\n", 7, "vehicle.interface",
       "has neither speed nor yaw_rate", "must be \"off\""},
      {kArs408 + on + "yaw_rate = \"0x300\"\n", 8, "vehicle.yaw_rate", "is the identifier of speed",
       "must be another"},
      {kArs408 + on + "speed = \"0x60A\"\n", 8, "vehicle.speed",
       "is 0x60A, which radar \"front\" sends", "another identifier"},
      {kArs408 + on + "speed = 0x300\n", 8, "vehicle.speed", "is 768", id},
      {kArs408 + on + "speed = \"300\"\n", 8, "vehicle.speed", "is \"300\"", id},
      {kArs408 + on + "speed = \"0x\"\n", 8, "vehicle.speed", "is \"0x\"", id},
      {kArs408 + on + "speed = \"0x800\"\n", 8, "vehicle.speed", "is \"0x800\"", id},
      {kArs408 + on + "speed = \"0x30 0\"\n", 8, "vehicle.speed", "is \"0x30 0\"", id},
      {kArs408 + "[vehicle]\ninterface = \"auto\"\n", 7, "vehicle.interface", "is \"auto\"",
       "the name of a CAN interface, not \"auto\", or \"off\""},
      {kArs408 + "[vehicle]\ninterface = \"\"\n", 7, "vehicle.interface", "is \"\"", "\"off\""},
      {kArs408 + on + "speed_delay_s = 0.3\n", 8, "vehicle.speed_delay_s", "is 0.3",
       "from 0 to 0.2"},
  });
  // Off, feedback is allowed.
  CHECK(message_of(kArs408 + "motion_feedback = true\n[vehicle]\ninterface = \"off\"\n") ==
        "accepted");
}

}  // namespace
}  // namespace cremed
