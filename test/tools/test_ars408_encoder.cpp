// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <string>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/ars408_signals.hpp"
#include "test/can_decoders/hex_frame.hpp"
#include "tools/simulate/ars408_encoder.hpp"

namespace {

using cremed::CanFrame;
using cremed::encode_ars408;
using cremed::encode_ars408_cluster;
using cremed::encode_ars408_object;
using cremed::test::bytes_of;
using cremed::test::hex_frame;

/// A message, the mask of its non-reserved bits, and its round trip through decoder and encoder.
struct Message {
  std::string name;
  std::uint32_t id;
  std::string used_bits;
  std::function<CanFrame(std::uint8_t, const CanFrame&)> again;
};

const std::array<Message, 8>& messages() {
  static const std::array<Message, 8> kAll{{
      {"0x201", 0x201, "201#C0FFFE03F7FE001C",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408(sensor,
                              *cremed::decode_ars408<cremed::Ars408RadarState>(bytes_of(frame)));
       }},
      {"0x600", 0x600, "600#FFFFFFFFF0",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408(sensor,
                              *cremed::decode_ars408<cremed::Ars408ClusterStatus>(bytes_of(frame)));
       }},
      {"0x60A", 0x60A, "60A#FFFFFFF0",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408(sensor,
                              *cremed::decode_ars408<cremed::Ars408ObjectStatus>(bytes_of(frame)));
       }},
      {"0x60B", 0x60B, "60B#FFFFFFFFFFFFE7FF",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408_object(sensor,
                                     *cremed::decode_ars408<cremed::Ars408Object>(bytes_of(frame)));
       }},
      {"0x60C", 0x60C, "60C#FFFFFFFFFFE0FC",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408(sensor,
                              *cremed::decode_ars408<cremed::Ars408ObjectQuality>(bytes_of(frame)));
       }},
      {"0x700", 0x700, "700#FFFFFF03",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408(sensor,
                              *cremed::decode_ars408<cremed::Ars408Version>(bytes_of(frame)));
       }},
      {"0x701", 0x701, "701#FFFFFBFFFFFFE7FF",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408_cluster(
             sensor, *cremed::decode_ars408<cremed::Ars408Cluster>(bytes_of(frame)));
       }},
      {"0x702", 0x702, "702#FFFFFFF7FF",
       [](std::uint8_t sensor, const CanFrame& frame) {
         return encode_ars408(
             sensor, *cremed::decode_ars408<cremed::Ars408ClusterQuality>(bytes_of(frame)));
       }},
  }};
  return kAll;
}

}  // namespace

TEST_CASE("any ARS408 frame comes out of decoder and encoder as it went in") {
  std::mt19937_64 engine(408);
  for (const Message& message : messages()) {
    CAPTURE(message.name);
    const CanFrame used = hex_frame(message.used_bits);
    for (std::uint8_t sensor = 0; sensor < 8; ++sensor) {
      for (int i = 0; i < 300; ++i) {
        CanFrame frame = used;
        frame.id = message.id + 0x10U * sensor;
        for (std::size_t k = 0; k < frame.length; ++k) {
          frame.data[k] = static_cast<std::uint8_t>(frame.data[k] & engine());
        }
        const CanFrame again = message.again(sensor, frame);
        REQUIRE(again.id == frame.id);
        REQUIRE(again.length == frame.length);
        REQUIRE(again.data == frame.data);
      }
    }
  }
}

TEST_CASE("ARS408 targets become the published bytes") {
  cremed::Ars408General cluster{.id = 0, .x_m = 2.4, .y_m = -0.7, .rcs_dbm2 = -28.5};
  cluster.dyn_prop = cremed::Ars408DynProp::stationary;
  CHECK(encode_ars408_cluster(0, cluster).data == hex_frame("701#004E81FC80200147").data);

  cremed::Ars408General object{.id = 32, .x_m = 11.4, .y_m = 0.2, .rcs_dbm2 = 26.0};
  object.dyn_prop = cremed::Ars408DynProp::stationary;
  CHECK(encode_ars408_object(0, object).data == hex_frame("60B#204FEC00802001B4").data);

  const cremed::Ars408ClusterStatus status{
      .near_count = 80, .far_count = 36, .counter = 22545, .interface_version = 1};
  CHECK(encode_ars408(0, status).data == hex_frame("600#5024581110").data);
}

TEST_CASE("ARS408 values beyond the frame's range become its limits, others the nearest step") {
  struct Row {
    cremed::Ars408General target;
    cremed::Ars408General expected;
  };
  const auto row = GENERATE(
      Row{{.x_m = 1e9, .y_m = 1e9, .vx_mps = 1e9, .vy_mps = 1e9, .rcs_dbm2 = 1e9},
          {.x_m = 1138.2, .y_m = 102.3, .vx_mps = 127.75, .vy_mps = 63.75, .rcs_dbm2 = 63.5}},
      Row{{.x_m = -1e9, .y_m = -1e9, .vx_mps = -1e9, .vy_mps = -1e9, .rcs_dbm2 = -1e9},
          {.x_m = -500.0, .y_m = -102.3, .vx_mps = -128.0, .vy_mps = -64.0, .rcs_dbm2 = -64.0}},
      Row{{.x_m = 10.09, .y_m = 0.01, .vx_mps = -3.13, .vy_mps = 0.12, .rcs_dbm2 = 1.2},
          {.x_m = 10.0, .y_m = 0.1, .vx_mps = -3.25, .vy_mps = 0.0, .rcs_dbm2 = 1.0}});
  const CanFrame frame = encode_ars408_cluster(0, row.target);
  const auto decoded = cremed::decode_ars408<cremed::Ars408Cluster>(bytes_of(frame));
  REQUIRE(decoded);
  CHECK(decoded->x_m == Approx(row.expected.x_m));
  CHECK(decoded->y_m == Approx(row.expected.y_m));
  CHECK(decoded->vx_mps == Approx(row.expected.vx_mps));
  CHECK(decoded->vy_mps == Approx(row.expected.vy_mps));
  CHECK(decoded->rcs_dbm2 == Approx(row.expected.rcs_dbm2));
}

TEST_CASE("a rms code is the smallest that covers the standard deviation") {
  struct Row {
    double standard_deviation;
    unsigned code;
  };
  const auto row = GENERATE(Row{0.0, 0}, Row{0.005, 0}, Row{0.0051, 1}, Row{0.135, 13},
                            Row{0.136, 14}, Row{0.288, 16}, Row{10.0, 30}, Row{50.0, 30});
  CAPTURE(row.standard_deviation);
  CHECK(unsigned{cremed::ars408_rms_code(row.standard_deviation)} == row.code);
}
