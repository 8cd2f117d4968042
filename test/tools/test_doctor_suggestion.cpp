// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/estimator/doubt/radar/self_check.hpp"
#include "test/tools/doctor_bench.hpp"
#include "tools/doctor/suggestion.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// Observation without a configuration.
Observation observed(const Recording& traffic) {
  Configuration nothing;
  nothing.odometry.enabled = false;
  return observe(nothing, traffic);
}

std::string suggested(const Recording& traffic) {
  return suggested_configuration(observed(traffic));
}

RadarConfiguration ars408(const std::string& name, const std::string& interface,
                          std::uint8_t sensor_id) {
  RadarConfiguration radar = default_radars()[0];
  radar.name = name;
  radar.interface = interface;
  radar.decoder = Ars408Options{.sensor_id = sensor_id};
  return radar;
}

/// Fills in the mounts as a user would.
std::string filled_in(std::string text) {
  const std::string gap = "\"FILL IN\"";
  for (std::size_t at = text.find(gap); at != std::string::npos; at = text.find(gap)) {
    text.replace(at, gap.size(), "0.5");
  }
  return text;
}

/// Interface and radar of each table, with the mounts filled in.
std::vector<std::string> radars_in(const std::string& suggestion) {
  std::vector<std::string> radars;
  for (const RadarConfiguration& radar :
       parse_configuration(filled_in(suggestion), "suggested.toml").radars) {
    radars.push_back(radar.interface + ": " + radar.decoder.describe());
    CHECK(radar.ego_motion.vehicle_from_radar.yaw_rad == 0.5);
  }
  return radars;
}

}  // namespace

TEST_CASE("One ARS408 is suggested, and its mount has to be filled in") {
  const std::string text = suggested(recording_of({ars408("a", "can0", 0)}));
  CAPTURE(text);
  CHECK(radars_in(text) == std::vector<std::string>{"can0: an ARS408 with sensor id 0"});
  try {
    parse_configuration(text, "suggested.toml");
    FAIL("a mount that nobody filled in was accepted");
  } catch (const ConfigurationError& error) {
    const std::string message = error.what();
    CHECK_THAT(message, Catch::Contains("suggested.toml:"));
    for (const char* key : {"x_m", "y_m", "yaw_rad"}) {
      CHECK_THAT(message, Catch::Contains(std::string("radar.mount.") + key +
                                          ": is \"FILL IN\"; must be a number from "));
    }
  }
}

TEST_CASE("Five ARS408 on two buses are suggested with their ids") {
  const std::string text = suggested(
      recording_of({ars408("a", "can1", 0), ars408("b", "can0", 0), ars408("c", "can0", 3),
                    ars408("d", "can1", 1), ars408("e", "can1", 7)}));
  CAPTURE(text);
  CHECK(radars_in(text) == std::vector<std::string>{"can0: an ARS408 with sensor id 0",
                                                    "can0: an ARS408 with sensor id 3",
                                                    "can1: an ARS408 with sensor id 0",
                                                    "can1: an ARS408 with sensor id 1",
                                                    "can1: an ARS408 with sensor id 7"});
}

TEST_CASE("A GPR is suggested with its base id") {
  RadarConfiguration gpr = default_radars()[1];
  gpr.decoder = BoschGprOptions{.base_id = 0x480};
  const std::string text = suggested(recording_of({gpr}));
  CAPTURE(text);
  CHECK(radars_in(text) == std::vector<std::string>{"can1: a Bosch GPR with base id 0x480"});
}

/// A frame of each identifier of a GPR's targets.
Recording gpr_targets(const std::string& interface, std::uint32_t base_id) {
  Recording traffic;
  for (std::uint32_t i = 0; i < 96; ++i) {
    traffic.push_back({interface, {.id = base_id + i, .length = 8}});
  }
  return traffic;
}

TEST_CASE("GPRs of one bus are suggested with an info_id each, which none of their targets has") {
  Recording traffic = gpr_targets("can0", 0x300);
  for (const std::uint32_t base_id : {0x480U, 0xC0U}) {
    const Recording more = gpr_targets("can0", base_id);
    traffic.insert(traffic.end(), more.begin(), more.end());
  }
  const std::string text = suggested(traffic);
  CAPTURE(text);
  CHECK(radars_in(text) == std::vector<std::string>{"can0: a Bosch GPR with base id 0xC0",
                                                    "can0: a Bosch GPR with base id 0x300",
                                                    "can0: a Bosch GPR with base id 0x480"});
  CHECK(examined_configuration(observed(traffic)).radars.size() == 3);
}

TEST_CASE("A radar that shares an identifier with another of its bus is left out, and told") {
  Recording traffic = gpr_targets("can0", 0x300);
  traffic.push_back({"can0", {.id = 0x630, .length = 5}});
  traffic.push_back({"can1", {.id = 0x630, .length = 5}});
  const std::string text = suggested(traffic);
  CAPTURE(text);
  CHECK(radars_in(text) == std::vector<std::string>{"can0: a Bosch GPR with base id 0x300",
                                                    "can1: an ARS408 with sensor id 3"});
  CHECK_THAT(text, Catch::Contains("# an ARS408 with sensor id 3 on can0 is left out: it shares "
                                   "CAN identifier 0x330 with another radar there; "));
  const auto told = radars_left_out(observed(traffic));
  check_first(told, Severity::warning, "an ARS408 with sensor id 3 on can0 is left out",
              "of its own");
  CHECK(told.size() == 1);
}

TEST_CASE("An ARS408 that sends objects, or nothing, is suggested with what sets it right") {
  RadarConfiguration objects = default_radars()[0];
  objects.decoder = Ars408Options{.output = Ars408Output::objects};
  CHECK_THAT(suggested(recording_of({objects})),
             Catch::Contains("\noutput = \"objects\"  # as it sends now; "));
  Recording silent = recording_of({ars408("a", "can0", 0)});
  report_state(silent, "can0", good_state());
  remove_if(silent, [](const BusFrame& entry) { return entry.frame.id != 0x201; });
  CHECK_THAT(suggested(silent), Catch::Contains("# It sends no targets now: "));
}

TEST_CASE("Where nothing is known there is nothing to suggest, and what was seen is told") {
  const Recording others = {{"can0", {.id = 0x123, .length = 8}},
                            {"can1", {.id = 0x7, .length = 2}}};
  CHECK(suggested(others).empty());
  const std::string text = no_suggestion(observed(others));
  CHECK_THAT(text, Catch::Contains("can0: frames, but none of a radar (0x123); "));
  CHECK_THAT(text, Catch::Contains("can1: frames, but none of a radar (0x7); "));
}

TEST_CASE("The name of an interface that a configuration would not take as it is is left out") {
  const char* const name = GENERATE("a\"b\\c\x1B", "can0:1", "a/b", "auto", "..");
  Recording traffic = recording_of({ars408("a", "can0", 0)});
  rename(traffic, "can0", name);
  CHECK(suggested(traffic).empty());
}

TEST_CASE("No more radars are suggested than a configuration may have") {
  Recording traffic;
  for (int bus = 0; bus < 9; ++bus) {
    for (const std::uint32_t id : {0x600U, 0x610U}) {
      traffic.push_back({"can" + std::to_string(bus), {.id = id, .length = 5}});
    }
  }
  CHECK(radars_in(suggested(traffic)).size() == kMaxRadars);
}

TEST_CASE(
    "Without mounts the radars of a suggestion are examined, and only doubts of Doppler stay") {
  Observation observation =
      observed(recording_of({ars408("a", "can0", 0), ars408("b", "can1", 2)}));
  const Configuration examined = examined_configuration(observation);
  REQUIRE(examined.radars.size() == 2);
  CHECK(examined.radars[1].name == "radar2");
  CHECK(examined.radars[1].interface == "can1");
  CHECK(examined.radars[1].ego_motion.registration.degrees_of_freedom == 3);
  CHECK_FALSE(examined.odometry.enabled);
  observation.radars.resize(1);
  observation.radars[0].status.belief.doubts = registration_contradicts_doppler |
                                               motions_contradict_each_other |
                                               covariance_too_large | positions_contradict_speed;
  drop_doubts_of_mounts(observation);
  CHECK(observation.radars[0].status.belief.doubts == positions_contradict_speed);
  CHECK(examined_configuration(observed({})).radars.empty());
}
