// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "test/can_decoders/gpr_frames.hpp"
#include "test/can_decoders/hex_frame.hpp"

namespace cremed::test {
namespace {

using Kind = ScanPart::Kind;

TEST_CASE("Every identifier of the radar is a slot") {
  BoschGprDecoder decoder({});
  for (unsigned slot = 0; slot < 48; ++slot) {
    for (const bool is_a : {true, false}) {
      const CanFrame frame = GprFrame{.slot = slot, .is_a = is_a, .counter = 2}.at(55);
      const ScanPart part = decoder.decode(frame);
      CHECK(part.kind == Kind::target);
      CHECK(part.message == (is_a ? 0 : 1));
      CHECK(part.slot == slot);
      CHECK(part.counter == 2);
      CHECK(part.stamp_us == 55);
      CHECK(std::equal(part.payload.begin(), part.payload.end(), frame.data.begin()));
    }
  }
  CHECK(decoder.counters().frames == 96);
  CHECK(decoder.counters().wrong_slot == 0);
  CHECK(decoder.counters().crc_errors == 0);
  CHECK(decoder.counters().counter_errors == 0);
}

TEST_CASE("The base identifier moves the radar") {
  BoschGprDecoder decoder({.base_id = 0x300, .info_id = 0x110});
  CanFrame frame = GprFrame{.slot = 47, .is_a = false}.at();
  CHECK(decoder.decode(frame).kind == Kind::none);
  CHECK(decoder.counters().frames == 0);
  frame.id = 0x35F;
  CHECK(decoder.decode(frame).slot == 47);
  frame.id = 0x360;
  CHECK(decoder.decode(frame).kind == Kind::none);
  frame.id = 0x2FF;
  CHECK(decoder.decode(frame).kind == Kind::none);
  decoder.decode(hex_frame("110#B4070000000000DB"));
  CHECK(decoder.info().has_value());
}

TEST_CASE("Bad GPR frames are counted by what is wrong") {
  struct Row {
    std::string name;
    std::string frame;
    std::function<void(CanFrame&)> spoil;
    DecoderCounters expected;
    bool used;
  };
  const auto nothing = [](CanFrame&) {};
  const std::string good = "200#0150807D0AFA202C";
  const std::vector<Row> rows = {
      {"good", good, nothing, {.frames = 1}, true},
      {"short", "200#0150807D0AFA20", nothing, {.frames = 1, .wrong_length = 1}, false},
      {"remote", good, [](CanFrame& f) { f.remote = true; }, {.frames = 1, .wrong_kind = 1}, false},
      {"fd", good, [](CanFrame& f) { f.fd = true; }, {.frames = 1, .wrong_kind = 1}, false},
      {"extended", good, [](CanFrame& f) { f.extended = true; }, {}, false},
      {"error", good, [](CanFrame& f) { f.error = true; }, {}, false},
      {"flag B on an A id", "200#00500000000060DA", nothing, {.frames = 1, .wrong_slot = 1}, false},
      {"flag A on a B id", "201#0150807D0AFA202C", nothing, {.frames = 1, .wrong_slot = 1}, false},
      {"number 48", "200#6150000000006036", nothing, {.frames = 1, .wrong_slot = 1}, false},
      {"number of another slot",
       "202#0150807D0AFA202C",
       nothing,
       {.frames = 1, .wrong_slot = 1},
       true},
      {"before the first id", "1FF#0150807D0AFA202C", nothing, {}, false},
      {"after the last id", "260#0150807D0AFA202C", nothing, {}, false},
  };
  for (const Row& row : rows) {
    INFO(row.name);
    BoschGprDecoder decoder({.crc_policy = CrcPolicy::enforce});
    CanFrame frame = hex_frame(row.frame);
    row.spoil(frame);
    CHECK((decoder.decode(frame).kind != Kind::none) == row.used);
    const DecoderCounters& counters = decoder.counters();
    CHECK(counters.frames == row.expected.frames);
    CHECK(counters.wrong_length == row.expected.wrong_length);
    CHECK(counters.wrong_kind == row.expected.wrong_kind);
    CHECK(counters.wrong_slot == row.expected.wrong_slot);
    CHECK(counters.crc_errors == 0);
  }
}

TEST_CASE("A transmitter that leaves its target number 0 is still read by identifier") {
  BoschGprDecoder decoder({});
  for (unsigned slot = 0; slot < 48; ++slot) {
    CHECK(decoder.decode(GprFrame{.slot = slot, .own_id = 0}.at()).slot == slot);
  }
  CHECK(decoder.counters().wrong_slot == 47);
}

TEST_CASE("The checksum policy decides about a wrong checksum") {
  struct Row {
    CrcPolicy policy;
    std::uint64_t errors;
    bool used;
  };
  for (const Row& row : {Row{CrcPolicy::off, 0, true}, Row{CrcPolicy::count, 1, true},
                         Row{CrcPolicy::enforce, 1, false}}) {
    BoschGprDecoder decoder({.crc_policy = row.policy});
    INFO(static_cast<int>(row.policy));
    CHECK((decoder.decode(hex_frame("200#01500000000060D2")).kind == Kind::target) == row.used);
    CHECK(decoder.counters().crc_errors == row.errors);
    decoder.decode(hex_frame("100#B4070000000000DA"));
    // Another node's frame at the identifier of Info is no fault of the sensor.
    const bool is_info_used = row.policy == CrcPolicy::off;
    CHECK(decoder.info().has_value() == is_info_used);
    CHECK(decoder.health().is_known == is_info_used);
    CHECK(decoder.counters().crc_errors == 2 * row.errors);
    CHECK(decoder.counters().state_frames == (is_info_used ? 1 : 0));
  }
}

TEST_CASE("A message's own counter shows loss and drops nothing") {
  // Counter 0 1 2 3 0 2 3 3 0 on one identifier: the step to 2 and the second 3 are errors.
  const std::vector<std::pair<std::string, std::uint64_t>> sequence = {
      {"200#0150000000002094", 0}, {"200#8150000000006026", 0}, {"200#015100000000A0F4", 0},
      {"200#815100000000E046", 0}, {"200#0152000000002018", 0}, {"200#815200000000A09F", 1},
      {"200#015300000000E06B", 1}, {"200#815300000000E0CA", 2}, {"200#0154000000002091", 2}};
  BoschGprDecoder decoder({.crc_policy = CrcPolicy::enforce});
  for (const auto& [frame, errors] : sequence) {
    INFO(frame);
    CHECK(decoder.decode(hex_frame(frame)).kind == Kind::target);
    CHECK(decoder.counters().counter_errors == errors);
  }
}

TEST_CASE("Counters of different identifiers are independent") {
  BoschGprDecoder decoder({});
  decoder.decode(GprFrame{.slot = 0, .counter = 0}.at());
  decoder.decode(GprFrame{.slot = 1, .counter = 3}.at());
  decoder.decode(GprFrame{.slot = 0, .is_a = false, .counter = 2}.at());
  decoder.decode(GprFrame{.slot = 0, .counter = 1}.at());
  decoder.decode(GprFrame{.slot = 1, .counter = 0}.at());
  CHECK(decoder.counters().counter_errors == 0);
}

TEST_CASE("After a dropped frame any counter is right") {
  BoschGprDecoder decoder({.crc_policy = CrcPolicy::enforce});
  decoder.decode(GprFrame{.counter = 0}.at());
  CanFrame corrupt = GprFrame{.counter = 1}.at();
  corrupt.data[7] ^= 1U;
  decoder.decode(corrupt);
  decoder.decode(GprFrame{.counter = 3}.at());
  CHECK(decoder.counters().counter_errors == 0);
  decoder.decode(GprFrame{.counter = 1}.at());
  CHECK(decoder.counters().counter_errors == 1);
}

TEST_CASE("The latest info is kept") {
  BoschGprDecoder decoder({});
  CHECK_FALSE(decoder.info().has_value());
  CHECK(decoder.decode(hex_frame("100#B4070000000000DB")).kind == Kind::none);
  CHECK(decoder.info().value().temperature_degc == 40);
  decoder.decode(hex_frame("100#01FCFFFFFFFFC380"));
  CHECK(decoder.info().value().temperature_degc == -78);
  CHECK(decoder.counters().state_frames == 2);
  CHECK(decoder.counters().frames == 2);
  CHECK(decoder.counters().counter_errors == 1);
}

TEST_CASE("A scan of the GPR is 48 slots without a header") {
  const ScanFraming framing = BoschGprDecoder({}).framing();
  CHECK_FALSE(framing.has_header);
  CHECK(framing.counter_modulus == 4);
  CHECK(framing.slot_count == 48);
  CHECK(framing.messages == 2);
}

}  // namespace
}  // namespace cremed::test
