// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <catch2/catch.hpp>

#include "test/daemon/configuration_texts.hpp"

namespace cremed {
namespace {

TEST_CASE("values that contradict each other are refused") {
  check_refused({
      {kArs408 + "[radar.limits]\nmin_range_m = 30\nmax_range_m = 20\n", 8,
       "radar.limits.max_range_m", "is 20", "greater than min_range_m = 30"},
      {kArs408 + "limits.min_range_m = 300\n", 6, "radar.limits.min_range_m", "is 300",
       "less than max_range_m = 300"},
      {kGpr + "info_id = 0x25F\n", 6, "radar.info_id", "makes", "outside base_id to base_id + 95"},
      {kGpr + "base_id = 0x0C0\n", 6, "radar.base_id", "makes", "outside base_id to base_id + 95"},
      {kArs408 + "[output]\ntum_source = \"rear\"\n", 7, "output.tum_source", "is \"rear\"",
       "the name of a radar"},
      {kArs408 + "[output]\ntum_source = \"fused\"\n", 7, "output.tum_source", "is \"fused\"",
       "\"fused\" for the same of two radars or more"},
      {kArs408 + radar_text("left", "bosch_gpr", "can1") +
           "[odometry]\nenabled = false\n[output]\ntum_source = \"fused\"\n",
       14, "output.tum_source", "is \"fused\"", "\"fused\" for the same of two radars or more"},
      {kArs408 + "[odometry]\nenabled = false\n[output]\nnav_msgs_odometry = \"/odometry\"\n", 9,
       "output.nav_msgs_odometry", "is to be published, but odometry.enabled = false", "\"\""},
      {kArs408 + "[odometry]\nenabled = false\n[output]\ntum_source = \"odometry\"\n", 9,
       "output.tum_source", "is \"odometry\"", "\"odometry\" unless that is off"},
      {kArs408 + "[odometry]\nenabled = false\n[output]\nodometry = \"a\"\n", 9, "output.odometry",
       "is to be written, but odometry.enabled = false", "must be \"\""},
      {kArs408 + "[odometry]\npredicted_s = 1.5\n", 7, "odometry.predicted_s", "is 1.5",
       "less than lost_s = 1"},
      {kArs408 + "[output]\nodometry = \"a\"\ntum = \"a\"\n", 8, "output.tum",
       "is the file of odometry", "another path"},
      {kArs408 + "[output]\nodometry = \"a\"\ncsv = \"a\"\n", 7, "output.odometry",
       "is the file of csv", "another path"},
      {kArs408 + "[output]\ncsv = \"a\"\ntum = \"a\"\n", 8, "output.tum", "is the file of csv",
       "another path"},
      {kArs408 + "calibration.stamp_offset_s = -0.4\n[live]\nmax_latency_s = 0.59\n", 8,
       "live.max_latency_s", "is 0.59 while stamp_offset_s of \"front\" is -0.4",
       "must be at least 0.6"},
  });
  CHECK(message_of(kArs408 + "calibration.stamp_offset_s = -0.4\n[live]\nmax_latency_s = 0.6\n") ==
        "accepted");
}

TEST_CASE("radars that cannot be told apart are refused at the later one") {
  const std::string same_bus = "is the interface of radar \"front\" (line 2), and both use CAN ";
  const std::string gpr_bus = "is the interface of radar \"left\" (line 2), and both use CAN ";
  const std::string right = "must be another interface, or have other identifiers";
  check_refused({
      {kArs408 + radar_text("front", "ars408", "can1"), 7, "radar.name",
       "is the name of radar \"front\" (line 2)", "must differ in more than case"},
      {kArs408 + radar_text("FRONT", "ars408", "can1"), 7, "radar.name",
       "is the name of radar \"front\" (line 2)", "must differ in more than case"},
      {kArs408 + radar_text("b", "ars408", "can0"), 9, "radar.interface",
       same_bus + "identifier 0x200", right},
      {kArs408 + "sensor_id = 3\n" + radar_text("b", "ars408", "can0") +
           "sensor_id = 3\noutput = \"objects\"\n",
       10, "radar.interface", same_bus + "identifier 0x230", right},
      {kGpr + radar_text("b", "bosch_gpr", "can0") + "info_id = 0x101\n", 9, "radar.interface",
       gpr_bus + "identifier 0x200", right},
      {kGpr + radar_text("b", "bosch_gpr", "can0") + "base_id = 0x25F\ninfo_id = 0x101\n", 9,
       "radar.interface", gpr_bus + "identifier 0x25F", right},
      {kGpr + radar_text("b", "bosch_gpr", "can0") + "base_id = 0x300\n", 9, "radar.interface",
       gpr_bus + "identifier 0x100", right},
      {kGpr + radar_text("b", "bosch_gpr", "can0") + "base_id = 0x300\ninfo_id = 0x25F\n", 9,
       "radar.interface", gpr_bus + "identifier 0x25F", right},
      {kArs408 + kGpr, 9, "radar.interface", same_bus + "identifier 0x200", right},
      {kArs408 + kGpr + "base_id = 0x500\ninfo_id = 0x701\n", 9, "radar.interface",
       same_bus + "identifier 0x701", right},
  });
}

TEST_CASE("more radars than anything has are refused") {
  std::string text;
  for (std::size_t i = 0; i <= kMaxRadars; ++i) {
    text += radar_text(std::to_string(i), "ars408", std::to_string(i));
  }
  check_refused({{text, 1, "radar", "has 17 tables", "at most 16"}});
}

}  // namespace
}  // namespace cremed
