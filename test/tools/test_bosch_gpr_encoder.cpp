// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "cremed/can_decoders/bosch_gpr_signals.hpp"
#include "test/can_decoders/hex_frame.hpp"
#include "tools/simulate/bosch_gpr_encoder.hpp"

namespace {

using cremed::CanFrame;
using cremed::encode_bosch_gpr;
using cremed::test::bytes_of;
using cremed::test::hex_frame;

constexpr std::uint32_t kBaseId = 0x200;

/// Random bits under the mask `used`, the bits `fixed`, and a correct checksum.
CanFrame random_frame(std::mt19937_64& engine, const std::string& used, const std::string& fixed) {
  CanFrame frame = hex_frame(used);
  const CanFrame ones = hex_frame(fixed);
  for (std::size_t i = 0; i < 7; ++i) {
    frame.data[i] = static_cast<std::uint8_t>((frame.data[i] & engine()) | ones.data[i]);
  }
  frame.data[7] = cremed::crc8_j1850(std::span(frame.data).first(7));
  return frame;
}

}  // namespace

TEST_CASE("any GPR frame comes out of decoder and encoder as it went in") {
  std::mt19937_64 engine(48);
  for (int i = 0; i < 3000; ++i) {
    const CanFrame a = random_frame(engine, "200#FEFFFFFFFFFFDF00", "200#0100000000002000");
    const auto target_a = cremed::decode_bosch_gpr<cremed::BoschGprTargetA>(bytes_of(a));
    REQUIRE(encode_bosch_gpr(kBaseId, *target_a).data == a.data);
    REQUIRE(encode_bosch_gpr(kBaseId, *target_a).id == kBaseId + 2U * target_a->id);

    const CanFrame b = random_frame(engine, "201#FEFFFFFFFF07C000", "201#0000000000000000");
    const auto target_b = cremed::decode_bosch_gpr<cremed::BoschGprTargetB>(bytes_of(b));
    REQUIRE(encode_bosch_gpr(kBaseId, *target_b).data == b.data);
    REQUIRE(encode_bosch_gpr(kBaseId, *target_b).id == kBaseId + 2U * target_b->id + 1U);

    const CanFrame info = random_frame(engine, "100#FFFFFFFFFFFFC300", "100#0000000000000000");
    const auto state = cremed::decode_bosch_gpr<cremed::BoschGprInfo>(bytes_of(info));
    REQUIRE(cremed::encode_bosch_gpr_info(0x100, *state).data == info.data);
    REQUIRE(cremed::encode_bosch_gpr_info(0x123, *state).id == 0x123);
  }
}

TEST_CASE("GPR targets become the bytes of the fact sheet") {
  cremed::BoschGprTargetA a;
  a.range_m = 10.0;
  a.radial_velocity_mps = -5.0;
  a.power_dbm2 = 10.0;
  a.azimuth_rad = 0.1;
  a.measured = true;
  CHECK(encode_bosch_gpr(kBaseId, a).data == hex_frame("200#0150807D0AFA202C").data);

  cremed::BoschGprTargetB b;
  b.azimuth_std_rad = 0.005;
  b.radial_velocity_std_mps = 0.125;
  b.range_std_m = 0.1875;
  b.existence = 0.96875;
  b.age_s = 0.045;
  CHECK(encode_bosch_gpr(kBaseId, b).data == hex_frame("201#804218BE70000009").data);
}

TEST_CASE("an empty GPR slot says so and nothing else") {
  cremed::BoschGprTargetA a;
  a.id = 47;
  a.counter = 1;
  a.range_m = 12.0;
  CHECK(encode_bosch_gpr(kBaseId, a).data == hex_frame("25E#5F00000000004022").data);
}

TEST_CASE("GPR values beyond the frame's range become its limits, others the nearest step") {
  struct Row {
    double value;
    double range_m;
    double speed_mps;
    double azimuth_rad;
    double power_dbm2;
  };
  const auto row =
      GENERATE(Row{1e6, 255.9375, 127.9375, 1.6382, 63.5}, Row{-1e6, 0.0, -128.0, -1.6384, -64.0},
               Row{1.23446, 1.25, 1.25, 1.2344, 1.0});
  cremed::BoschGprTargetA target;
  target.measured = true;
  target.range_m = target.radial_velocity_mps = row.value;
  target.azimuth_rad = target.power_dbm2 = row.value;
  const CanFrame frame = encode_bosch_gpr(kBaseId, target);
  const auto decoded = cremed::decode_bosch_gpr<cremed::BoschGprTargetA>(bytes_of(frame));
  CHECK(decoded->range_m == Approx(row.range_m));
  CHECK(decoded->radial_velocity_mps == Approx(row.speed_mps));
  CHECK(decoded->azimuth_rad == Approx(row.azimuth_rad));
  CHECK(decoded->power_dbm2 == Approx(row.power_dbm2));
}

TEST_CASE("the age is set in a finished GPR frame, which stays whole") {
  struct Row {
    std::int64_t age_us;
    double age_s;
  };
  const auto row = GENERATE(Row{0, 0.0}, Row{249, 0.0002}, Row{250, 0.0003}, Row{23'950, 0.0240},
                            Row{5'000'000, 0.8191}, Row{-10, 0.0});
  cremed::BoschGprTargetB target;
  target.id = 13;
  target.range_std_m = 0.1875;
  target.counter = 3;
  target.age_s = 0.5;
  CanFrame frame = encode_bosch_gpr(kBaseId, target);
  cremed::set_bosch_gpr_age(frame, row.age_us);
  target.age_s = row.age_s;
  CHECK(frame.data == encode_bosch_gpr(kBaseId, target).data);
}
