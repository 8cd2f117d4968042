// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/bosch_gpr_signals.hpp"
#include "test/can_decoders/hex_frame.hpp"
#include "test/can_decoders/signal_values.hpp"

namespace cremed::test {
namespace {

Approx about(double value) { return Approx(value).margin(1e-9).epsilon(0); }

bool crc_ok(const CanFrame& frame) { return crc8_j1850(bytes_of(frame).first(7)) == frame.data[7]; }

TEST_CASE("The checksum is SAE J1850") {
  const std::string digits = "123456789";
  const std::vector<std::uint8_t> bytes(digits.begin(), digits.end());
  CHECK(crc8_j1850(bytes) == 0x4B);
  const std::vector<std::pair<std::vector<std::uint8_t>, std::uint8_t>> published = {
      {{0x00, 0x00, 0x00, 0x00}, 0x59}, {{0xF2, 0x01, 0x83}, 0x37},
      {{0x0F, 0xAA, 0x00, 0x55}, 0x79}, {{0x00, 0xFF, 0x55, 0x11}, 0xB8},
      {{0x92, 0x6B, 0x55}, 0x8C},       {{0xFF, 0xFF, 0xFF, 0xFF}, 0x74},
  };
  for (const auto& [message, crc] : published) {
    CHECK(crc8_j1850(message) == crc);
  }
}

TEST_CASE("Message A holds the measurement") {
  struct Row {
    std::string frame;
    BoschGprTargetA expected;
    bool crc_ok;
  };
  const std::vector<Row> rows = {
      {"200#0150807D0AFA202C", {true, 0, 10.0, -5.0, 10.0, 0.1, true, 0}, true},
      {"202#83FF01807E1E7B96", {true, 1, 63.9375, 0.0, -1.5, -0.5, true, 1}, true},
      {"218#99FF0B819F85A84A", {true, 12, 127.9375, 2.0625, 31.5, 0.8726, true, 2}, true},
      {"25E#DFFFFFBFBFFFEF62", {true, 47, 255.9375, 127.9375, 63.5, 1.6382, true, 3}, true},
      {"202#0300004040003053", {true, 1, 0.0, -128.0, -64.0, -1.6384, true, 0}, true},
      {"25E#5F00000000004022", {true, 47, 0.0, 0.0, 0.0, 0.0, false, 1}, true},
      {"200#01500000000060D2", {true, 0, 10.0, 0.0, 0.0, 0.0, true, 1}, false},
      {"200#00500000000060DA", {false, 0, 10.0, 0.0, 0.0, 0.0, true, 1}, true},
      {"200#6150000000006036", {true, 48, 10.0, 0.0, 0.0, 0.0, true, 1}, true},
  };
  for (const Row& row : rows) {
    INFO(row.frame);
    const CanFrame frame = hex_frame(row.frame);
    const auto a = decode_bosch_gpr<BoschGprTargetA>(bytes_of(frame));
    REQUIRE(a.has_value());
    CHECK(differences(*a, row.expected) == "");
    CHECK(crc_ok(frame) == row.crc_ok);
    CHECK_FALSE(decode_bosch_gpr<BoschGprTargetA>(bytes_of(frame).first(7)).has_value());
  }
}

TEST_CASE("Message B holds the quality") {
  struct Row {
    std::string frame;
    BoschGprTargetB expected;
    bool crc_ok;
  };
  const std::vector<Row> rows = {
      {"201#804218BE70000009", {false, 0, 0.005, 0.125, 0.1875, 0.96875, 0.045, 0}, true},
      {"219#9840201004008054", {false, 12, 0.001, 0.125, 0.25, 0.25, 0.0016, 2}, true},
      {"25F#DEFFFFFFFF07C04F", {false, 47, 0.063, 3.9375, 3.9375, 0.96875, 0.8191, 3}, true},
      {"25F#DEFFFFFFFFFFFFB5", {false, 47, 0.063, 3.9375, 3.9375, 0.96875, 0.8191, 3}, false},
      {"201#80FF07805500C0F4", {false, 0, 0.063, 3.9375, 0.0, 0.0, 0.0342, 3}, false},
      {"201#000000000000003A", {false, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0}, false},
  };
  for (const Row& row : rows) {
    INFO(row.frame);
    const CanFrame frame = hex_frame(row.frame);
    const auto b = decode_bosch_gpr<BoschGprTargetB>(bytes_of(frame));
    REQUIRE(b.has_value());
    CHECK(differences(*b, row.expected) == "");
    CHECK(crc_ok(frame) == row.crc_ok);
    CHECK_FALSE(decode_bosch_gpr<BoschGprTargetB>(bytes_of(frame).first(7)).has_value());
  }
}

TEST_CASE("The info message holds the sensor's health") {
  struct Row {
    std::string frame;
    BoschGprInfo expected;
  };
  const std::vector<Row> rows = {
      {"100#B4070000000000DB", {.sensor_type = 4, .temperature_degc = 40}},
      {"100#01FCFFFFFFFFC380",
       {1, -78, true, true, true, true, true, true, 16777215, 255, true, 3}},
      {"100#FF0380C403F68004",
       {.sensor_type = 7,
        .temperature_degc = 177,
        .trouble_code = 123456,
        .trouble_order = 123,
        .counter = 2}},
      {"100#9009000000000000", {.temperature_degc = 100, .blind = true}},
      {"100#9011000000000000", {.temperature_degc = 100, .software_failure = true}},
      {"100#9021000000000000", {.temperature_degc = 100, .hardware_failure = true}},
      {"100#9041000000000000", {.temperature_degc = 100, .can_failure = true}},
      {"100#9081000000000000", {.temperature_degc = 100, .configuration_failure = true}},
      {"100#9001010000000000", {.temperature_degc = 100, .diagnostic_mode = true}},
      {"100#9001000000000200", {.temperature_degc = 100, .not_safe = true}},
  };
  for (const Row& row : rows) {
    INFO(row.frame);
    const CanFrame frame = hex_frame(row.frame);
    const auto info = decode_bosch_gpr<BoschGprInfo>(bytes_of(frame));
    REQUIRE(info.has_value());
    CHECK(differences(*info, row.expected) == "");
    CHECK_FALSE(decode_bosch_gpr<BoschGprInfo>(bytes_of(frame).first(7)).has_value());
  }
}

TargetPayload target(const char* a, const char* b) {
  TargetPayload target;
  const CanFrame frame_a = hex_frame(a);
  const CanFrame frame_b = hex_frame(b);
  std::copy_n(frame_a.data.begin(), 8, target[0].begin());
  std::copy_n(frame_b.data.begin(), 8, target[1].begin());
  return target;
}

TEST_CASE("Two messages make a detection") {
  const TargetPayload both = target("200#0150807D0AFA202C", "201#804218BE70000009");
  const Detection d = BoschGprDecoder({}).detection(both);
  CHECK(d.validity == Validity::usable);
  CHECK(d.motion == Motion::unknown);
  CHECK(d.range_m == 10.0);
  CHECK(d.azimuth_rad == about(0.1));
  CHECK(d.doppler_mps == -5.0);
  CHECK(d.rcs_dbm2 == 10.0);
  CHECK(d.range_std_m == 0.1875);
  CHECK(d.azimuth_std_rad == about(0.005));
  CHECK(d.doppler_std_mps == 0.125);

  const Detection turned =
      BoschGprDecoder({.invert_azimuth = true, .invert_doppler = true}).detection(both);
  CHECK(turned.azimuth_rad == about(-0.1));
  CHECK(turned.doppler_mps == 5.0);
  CHECK(turned.range_m == 10.0);
}

TEST_CASE("A standard deviation of 0 means less than half a step") {
  const Detection d =
      BoschGprDecoder({}).detection(target("200#0150807D0AFA202C", "201#0000000000000000"));
  CHECK(d.validity == Validity::usable);
  CHECK(d.range_std_m == 0.03125);
  CHECK(d.azimuth_std_rad == about(0.0005));
  CHECK(d.doppler_std_mps == 0.03125);
}

TEST_CASE("What keeps a target out") {
  const char* good_b = "201#804218BE70000009";  // pExist 0.96875
  const char* weak_b = "219#9840201004008054";  // pExist 0.25
  const BoschGprDecoder strict({.min_existence = 0.5});
  CHECK(strict.detection(target("200#0150807D0AFA202C", good_b)).validity == Validity::usable);
  CHECK(strict.detection(target("200#0150807D0AFA202C", weak_b)).validity ==
        Validity::low_existence);
  CHECK(strict.detection(target("25E#5F00000000004022", weak_b)).validity == Validity::empty);
  const Detection at_sensor = strict.detection(target("202#0300004040003053", weak_b));
  CHECK(at_sensor.validity == Validity::no_position);
  CHECK(at_sensor.range_std_m == 0.0);
  const BoschGprDecoder exact({.min_existence = 0.25});
  CHECK(exact.detection(target("200#0150807D0AFA202C", weak_b)).validity == Validity::usable);
}

}  // namespace
}  // namespace cremed::test
