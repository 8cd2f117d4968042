// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <limits>
#include <string>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408_commands.hpp"
#include "test/can_decoders/ars408_rows.hpp"
#include "test/can_decoders/hex_frame.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void check_frame(const CanFrame& frame, const std::string& expected) {
  CAPTURE(expected);
  const CanFrame wanted = hex_frame(expected);
  CHECK(frame.id == wanted.id);
  CHECK(frame.length == wanted.length);
  CHECK(frame.data == wanted.data);
  CHECK(frame.is_classic_data());
}

Ars408Command all_outputs(std::uint8_t output_code) {
  return {.output_code = output_code,
          .sends_quality = true,
          .sends_extended = true,
          .sort_code = std::uint8_t{1}};
}

Ars408Command stored(Ars408Command command) {
  command.store = true;
  return command;
}

}  // namespace

TEST_CASE("RadarCfg: the published and known frames") {
  check_frame(encode_ars408_command(0, stored(all_outputs(1))), "200#F8000000089C0000");
  check_frame(encode_ars408_command(0, stored(all_outputs(2))), "200#F8000000109C0000");
  check_frame(encode_ars408_command(0, all_outputs(2)), "200#78000000101C0000");
  check_frame(encode_ars408_command(0, stored({.sensor_id = std::uint8_t{1}})),
              "200#8200000001800000");
  check_frame(
      encode_ars408_command(0, {.max_distance_m = 250.0, .rcs_threshold_code = std::uint8_t{1}}),
      "200#011F400000000300");
}

TEST_CASE("RadarCfg: each signal sets its valid bit and nothing else") {
  check_frame(encode_ars408_command(0, {}), "200#0000000000000000");
  check_frame(encode_ars408_command(7, {.max_distance_m = 2046.0}), "270#01FFC00000000000");
  check_frame(encode_ars408_command(1, {.sensor_id = std::uint8_t{7}}), "210#0200000007000000");
  check_frame(encode_ars408_command(1, {.power_code = std::uint8_t{7}}), "210#04000000E0000000");
  check_frame(encode_ars408_command(1, {.output_code = std::uint8_t{3}}), "210#0800000018000000");
  check_frame(encode_ars408_command(1, {.sends_quality = true}), "210#1000000000040000");
  check_frame(encode_ars408_command(1, {.sends_quality = false}), "210#1000000000000000");
  check_frame(encode_ars408_command(1, {.sends_extended = true}), "210#2000000000080000");
  check_frame(encode_ars408_command(1, {.sort_code = std::uint8_t{7}}), "210#4000000000700000");
  check_frame(encode_ars408_command(1, {.store = false}), "210#8000000000000000");
  check_frame(encode_ars408_command(1, {.relay_control = true}), "210#0000000000030000");
  check_frame(encode_ars408_command(1, {.rcs_threshold_code = std::uint8_t{7}}),
              "210#0000000000000F00");
}

TEST_CASE("RadarCfg: a value beyond the frame becomes its limit, or keeps its low bits") {
  check_frame(encode_ars408_command(0, {.max_distance_m = 1e9}), "200#01FFC00000000000");
  check_frame(encode_ars408_command(0, {.max_distance_m = -1.0}), "200#0100000000000000");
  check_frame(encode_ars408_command(0, {.max_distance_m = kNan}), "200#0100000000000000");
  check_frame(encode_ars408_command(0, {.max_distance_m = 201.0}), "200#0119400000000000");
  check_frame(encode_ars408_command(0, {.output_code = std::uint8_t{255}}), "200#0800000018000000");
  check_frame(encode_ars408_command(9, {}), "210#0000000000000000");
}

TEST_CASE("FilterCfg: the known frames, and what they say") {
  const auto filter = [](bool active, Ars408Criterion criterion, double min, double max,
                         bool for_objects = false) {
    return encode_ars408_filter(0, {.for_objects = for_objects,
                                    .active = active,
                                    .criterion = criterion,
                                    .min = min,
                                    .max = max});
  };
  check_frame(filter(true, Ars408Criterion::range_m, 5.0, 100.0), "202#0E003203E8");
  check_frame(filter(true, Ars408Criterion::x_m, 5.0, 100.0, true), "202#D609DD0BB8");
  check_frame(filter(true, Ars408Criterion::y_m, -20.1, 19.9, true), "202#CE079B0863");
  check_frame(filter(false, Ars408Criterion::rcs_dbm2, -10.0, 30.0), "202#2A06400C80");
  check_frame(filter(true, Ars408Criterion::range_m, -1.0, 1e9), "202#0E00000FFF");
}

TEST_CASE("FilterCfg: a question has no valid bit") {
  check_frame(encode_ars408_filter_query(0, false, Ars408Criterion::rcs_dbm2), "202#2800000000");
  check_frame(encode_ars408_filter_query(5, true, Ars408Criterion::target_count), "252#8000000000");
}

TEST_CASE("Speed: direction and magnitude") {
  check_frame(encode_ars408_speed(0, 16.0), "300#4320");
  check_frame(encode_ars408_speed(0, -1.0), "300#8032");
  check_frame(encode_ars408_speed(0, 0.0), "300#0000");
  check_frame(encode_ars408_speed(0, 0.009), "300#0000");
  check_frame(encode_ars408_speed(3, 1e6), "330#5FFF");
  check_frame(encode_ars408_speed(0, -kInfinity), "300#9FFF");
  check_frame(encode_ars408_speed(0, kNan), "300#0000");
}

TEST_CASE("Yaw rate: counter-clockwise is positive") {
  check_frame(encode_ars408_yaw_rate(0, 0.0), "301#8000");
  check_frame(encode_ars408_yaw_rate(0, deg(10.0)), "301#83E8");
  check_frame(encode_ars408_yaw_rate(0, deg(-10.0)), "301#7C18");
  check_frame(encode_ars408_yaw_rate(2, deg(1e4)), "321#FFFF");
  check_frame(encode_ars408_yaw_rate(0, deg(-1e4)), "301#0000");
  check_frame(encode_ars408_yaw_rate(0, kNan), "301#8000");
}
