// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <catch2/catch.hpp>

#include "daemon/configuration/configuration_summary.hpp"
#include "test/daemon/configuration_texts.hpp"

namespace cremed {
namespace {

std::string summary_of(const std::string& text) {
  return configuration_summary(parse_configuration(text, "test.toml"));
}

std::string with_yaw(const std::string& yaw) {
  std::string text = kArs408;
  return text.replace(text.find("0.25"), 4, yaw);
}

TEST_CASE("a configuration is shown as it was understood") {
  const std::string text = kArs408 + "sensor_id = 3\nmotion_feedback = true\n" +
                           radar_text("left", "bosch_gpr", "can1") +
                           "[output]\nlcm_url = \"none\"\ncsv = \"odo.csv\"\n";
  CHECK(summary_of(text) ==
        "radar           type      interface            x m      y m  yaw deg  identifiers\n"
        "front           ars408    can0               3.400   -0.500    14.32  0x231, 0x233-0x234, "
        "0x432, "
        "0x438, 0x630, 0x63A-0x63E, 0x730-0x732\n"
        "left            bosch_gpr can1               3.400   -0.500    14.32  0x100, 0x200-0x25F\n"
        "azimuth scale: front 1, left 1\n"
        "odometry: from front, left; told at every scan; its motion between scans is \"fused\"\n"
        "output: odo.csv\n"
        "sends on the buses: speed and yaw rate to front (motion_feedback)\n");
}

TEST_CASE("the summary says what the odometry does, where it goes, and that nothing is sent") {
  CHECK_THAT(summary_of(kArs408),
             Catch::Contains("odometry: from front; told at every scan\n") &&
                 Catch::Contains("output: LCM udpm://239.255.76.67:7667?ttl=0\n") &&
                 Catch::EndsWith("sends on the buses: nothing\n"));
  CHECK_THAT(summary_of(kArs408 + "[odometry]\nrate_hz = 50\n"),
             Catch::Contains("told 50 times a second\n"));
  CHECK_THAT(summary_of(kArs408 + "[odometry]\nenabled = false\n[output]\nlcm_url = \"none\"\n"),
             Catch::Contains("odometry: off\noutput: none\n"));
}

TEST_CASE(
    "a yaw beyond half a turn is doubted, with what it is in degrees and what it may be meant as") {
  const auto doubts = configuration_doubts(parse_configuration(with_yaw("5.0"), "test.toml"));
  REQUIRE(doubts.size() == 1);
  CHECK(doubts[0] ==
        "front: yaw_rad = 5 is 286.5 degrees; write -1.2832 if that is meant, and 0.0873 "
        "if 5 degrees are");
}

TEST_CASE("motion_feedback is doubted if targets are selected by the flag that it sets") {
  const std::string text = kArs408 + "motion_feedback = true\n";
  const auto doubts = configuration_doubts(parse_configuration(text, "test.toml"));
  REQUIRE(doubts.size() == 1);
  CHECK_THAT(doubts[0], Catch::StartsWith("front: motion_feedback = true, but keep_dyn_props"));
  CHECK(configuration_doubts(
            parse_configuration(text + "keep_dyn_props = [0, 1, 2, 3, 4, 5, 6, 7]\n", "test.toml"))
            .empty());
}

TEST_CASE("a yaw of up to half a turn is not doubted, however it is rounded") {
  const auto* yaw = GENERATE("0.0", "-1.5708", "3.1416", "-3.14159265358979");
  CHECK(configuration_doubts(parse_configuration(with_yaw(yaw), "test.toml")).empty());
}

TEST_CASE("an angle that is out of range as radians is refused with what it is from degrees") {
  CHECK_THAT(
      message_of(with_yaw("90")),
      Catch::Contains("radar.mount.yaw_rad: is 90; must be a number from -6.2832 to 6.2832 (90 "
                      "degrees are 1.5708)"));
  CHECK_THAT(message_of(with_yaw("1000")), Catch::EndsWith("to 6.2832"));
  CHECK_THAT(message_of(radar_text("front", "ars408", "can0") +
                        "[radar.calibration]\nstamp_offset_s = 2\n"),
             Catch::EndsWith("from -0.5 to 0.5"));
}

}  // namespace
}  // namespace cremed
