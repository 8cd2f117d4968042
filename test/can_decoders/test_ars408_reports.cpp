// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include "test/can_decoders/ars408_rows.hpp"

namespace cremed::test {
namespace {

TEST_CASE("0x201 reports configuration and faults") {
  const std::vector<Ars408Row<Ars408RadarState>> rows = {
      {"201#4019000010F40000",
       {.nvm_read = true,
        .max_distance_m = 200.0,
        .sort_code = 1,
        .speed_missing = true,
        .yaw_rate_missing = true,
        .sends_extended = true,
        .sends_quality = true,
        .output_code = 1}},
      {"231#C01F400003180004",
       {.nvm_read = true,
        .nvm_written = true,
        .max_distance_m = 250.0,
        .sensor_id = 3,
        .sends_quality = true,
        .output_code = 2,
        .rcs_threshold_code = 1}},
      {"271#4020BE01A7660000",
       {.nvm_read = true,
        .max_distance_m = 260.0,
        .persistent_error = true,
        .interference = true,
        .temperature_error = true,
        .temporary_error = true,
        .voltage_error = true,
        .power_code = 3,
        .sort_code = 2,
        .sensor_id = 7,
        .speed_missing = true,
        .sends_extended = true,
        .output_code = 1,
        .relay_control = true}},
      {"201#0000000000000000", {}},
      {"201#FFFFFFFFFFFFFFFF",
       {.nvm_read = true,
        .nvm_written = true,
        .max_distance_m = 2046.0,
        .persistent_error = true,
        .interference = true,
        .temperature_error = true,
        .temporary_error = true,
        .voltage_error = true,
        .power_code = 7,
        .sort_code = 7,
        .sensor_id = 7,
        .speed_missing = true,
        .yaw_rate_missing = true,
        .sends_extended = true,
        .sends_quality = true,
        .output_code = 3,
        .relay_control = true,
        .rcs_threshold_code = 7}},
      {"201#0000200000000000", {.persistent_error = true}},
      {"201#0000100000000000", {.interference = true}},
      {"201#0000080000000000", {.temperature_error = true}},
      {"201#0000040000000000", {.temporary_error = true}},
      {"201#0000020000000000", {.voltage_error = true}},
      {"201#0000000000400000", {.speed_missing = true}},
      {"201#0000000000800000", {.yaw_rate_missing = true}},
      {"201#0000000000200000", {.sends_extended = true}},
      {"201#0000000000100000", {.sends_quality = true}},
      {"201#0000000000040000", {.output_code = 1}},
      {"201#0000000000020000", {.relay_control = true}},
      {"201#0000000080000000", {.power_code = 1}},
      {"201#0000000200000000", {.power_code = 4}},
      {"201#0000400000000000", {.max_distance_m = 2.0}},
      {"201#0000000010000000", {.sort_code = 1}},
      {"201#0000000004000000", {.sensor_id = 4}},
      {"201#000000000000001C", {.rcs_threshold_code = 7}},
  };
  check_rows<Ars408RadarState>(rows);
}

TEST_CASE("0x700 reports the software version") {
  const std::vector<Ars408Row<Ars408Version>> rows = {
      {"700#041E0200", {4, 30, 2, false, false}},
      {"700#041E0202", {4, 30, 2, true, false}},
      {"700#041E0201", {4, 30, 2, false, true}},
      {"700#FFFFFFFF", {255, 255, 255, true, true}},
  };
  check_rows<Ars408Version>(rows);
}

TEST_CASE("0x700 of an older sensor lacks the byte of flags") {
  const std::vector<Ars408Row<Ars408Version>> rows = {{"700#041E02", {4, 30, 2, false, false}}};
  check_rows<Ars408Version>(rows);
}

TEST_CASE("0x204 reports one filter") {
  const std::vector<Ars408Row<Ars408FilterState>> rows = {
      {"204#0C003203E8", {false, true, Ars408Criterion::range_m, 5.0, 100.0}},
      {"204#D409DD0BB8", {true, true, Ars408Criterion::x_m, 5.0, 100.0}},
      {"204#CC079B0863", {true, true, Ars408Criterion::y_m, -20.1, 19.9}},
      {"204#2806400C80", {false, false, Ars408Criterion::rcs_dbm2, -10.0, 30.0}},
  };
  check_rows<Ars408FilterState>(rows);
}

TEST_CASE("0x204 scales its limits by the criterion") {
  using C = Ars408Criterion;
  const double speed_mps = 128.9925;
  const std::vector<Ars408Row<Ars408FilterState>> rows = {
      {"204#000000FFFF", {false, false, C::target_count, 0, 4095}},
      {"204#080000FFFF", {false, false, C::range_m, 0, 409.5}},
      {"204#100000FFFF", {false, false, C::azimuth_rad, deg(-50), deg(52.375)}},
      {"204#180000FFFF", {false, false, C::oncoming_radial_speed_mps, 0, speed_mps}},
      {"204#200000FFFF", {false, false, C::departing_radial_speed_mps, 0, speed_mps}},
      {"204#280000FFFF", {false, false, C::rcs_dbm2, -50, 52.375}},
      {"204#B00000FFFF", {true, false, C::lifetime_s, 0, 409.5}},
      {"204#B80000FFFF", {true, false, C::size_m2, 0, 102.375}},
      {"204#C0FFFF0003", {true, false, C::existence_code, 4095, 3}},
      {"204#C80000FFFF", {true, false, C::y_m, -409.5, 409.5}},
      {"204#D00000FFFF", {true, false, C::x_m, -500, 1138.2}},
      {"204#D8FFFF0000", {true, false, C::crossing_speed_a_mps, speed_mps, 0}},
      {"204#E0FFFF0000", {true, false, C::oncoming_speed_mps, speed_mps, 0}},
      {"204#E8FFFF0000", {true, false, C::crossing_speed_b_mps, speed_mps, 0}},
      {"204#F0FFFF0000", {true, false, C::departing_speed_mps, speed_mps, 0}},
      {"204#F8FFFF0F5A", {true, false, C::class_bits, 255, 0x5A}},
  };
  check_rows<Ars408FilterState>(rows);
}

TEST_CASE("Messages to the sensor are not the sensor's") {
  const std::vector<std::string> frames = {"200#F8000000089C0000",
                                           "200#F8000000109C0000",
                                           "200#8200000001800000",
                                           "200#011F400000000300",
                                           "202#0E003203E8",
                                           "202#D609DD0BB8",
                                           "202#CE079B0863",
                                           "202#2A06400C80",
                                           "300#4320",
                                           "300#8032",
                                           "300#0000",
                                           "300#5FFF",
                                           "301#8000",
                                           "301#83E8",
                                           "301#7C18",
                                           "301#0000",
                                           "400#0000",
                                           "401#0000000000000000",
                                           "008#00"};
  Ars408Decoder decoder({});
  for (const std::string& frame : frames) {
    INFO(frame);
    CHECK(decoder.decode(hex_frame(frame)).kind == ScanPart::Kind::none);
  }
  CHECK(decoder.counters().frames == 0);
}

}  // namespace
}  // namespace cremed::test
