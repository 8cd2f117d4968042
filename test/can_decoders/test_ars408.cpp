// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <functional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "test/can_decoders/ars408_rows.hpp"

namespace cremed::test {
namespace {

using Kind = ScanPart::Kind;

TEST_CASE("A header announces near and far clusters") {
  Ars408Decoder decoder({});
  const ScanPart part = decoder.decode(hex_frame("600#5024581110", 1234));
  CHECK(part.kind == Kind::header);
  CHECK(part.counter == 22545);
  CHECK(part.target_count == 80 + 36);
  CHECK(part.stamp_us == 1234);
}

TEST_CASE("A header can announce more targets than an id can name") {
  Ars408Decoder decoder({});
  CHECK(decoder.decode(hex_frame("600#FFFF000110")).target_count == 510);
}

TEST_CASE("A header announces objects") {
  Ars408Decoder decoder({.output = Ars408Output::objects});
  const ScanPart part = decoder.decode(hex_frame("60A#64FFFF10", 7));
  CHECK(part.kind == Kind::header);
  CHECK(part.counter == 65535);
  CHECK(part.target_count == 100);
}

TEST_CASE("Target messages become parts of the slot their id names") {
  struct Row {
    Ars408Output output;
    std::string frame;
    std::uint8_t message;
    std::uint8_t slot;
    Payload payload;
  };
  const std::vector<Row> rows = {
      {Ars408Output::clusters,
       "701#C86D625880200180",
       0,
       200,
       {0xC8, 0x6D, 0x62, 0x58, 0x80, 0x20, 0x01, 0x80}},
      {Ars408Output::clusters, "702#0508888671", 1, 5, {0x05, 0x08, 0x88, 0x86, 0x71}},
      {Ars408Output::objects,
       "60B#384F04028020019C",
       0,
       56,
       {0x38, 0x4F, 0x04, 0x02, 0x80, 0x20, 0x01, 0x9C}},
      {Ars408Output::objects,
       "60C#3884A33A0220E8",
       1,
       56,
       {0x38, 0x84, 0xA3, 0x3A, 0x02, 0x20, 0xE8}},
  };
  for (const Row& row : rows) {
    INFO(row.frame);
    Ars408Decoder decoder({.output = row.output});
    const ScanPart part = decoder.decode(hex_frame(row.frame, 99));
    CHECK(part.kind == Kind::target);
    CHECK(part.message == row.message);
    CHECK(part.slot == row.slot);
    CHECK(part.payload == row.payload);
    CHECK(part.stamp_us == 99);
    CHECK(decoder.counters().state_frames == 0);
  }
}

TEST_CASE("Bytes past the layout are not part of the payload") {
  Ars408Decoder decoder({});
  const ScanPart part = decoder.decode(hex_frame("702#0508888671AABBCC"));
  CHECK(part.message == 1);
  CHECK(part.payload == Payload{0x05, 0x08, 0x88, 0x86, 0x71});
}

TEST_CASE("Bad frames are counted by what is wrong and give nothing") {
  struct Row {
    std::string name;
    std::string frame;
    std::function<void(CanFrame&)> spoil;
    DecoderCounters counters;
  };
  const auto nothing = [](CanFrame&) {};
  const std::vector<Row> rows = {
      {"short general", "701#004E81FC802001", nothing, {.frames = 1, .wrong_length = 1}},
      {"short quality", "702#05088886", nothing, {.frames = 1, .wrong_length = 1}},
      {"short header", "600#50245811", nothing, {.frames = 1, .wrong_length = 1}},
      {"empty header", "600#", nothing, {.frames = 1, .wrong_length = 1}},
      {"short state", "201#40190000", nothing, {.frames = 1, .wrong_length = 1}},
      {"remote",
       "701#004E81FC80200147",
       [](CanFrame& f) { f.remote = true; },
       {.frames = 1, .wrong_kind = 1}},
      {"fd",
       "701#004E81FC80200147",
       [](CanFrame& f) { f.fd = true; },
       {.frames = 1, .wrong_kind = 1}},
      {"extended", "701#004E81FC80200147", [](CanFrame& f) { f.extended = true; }, {}},
      {"error", "701#004E81FC80200147", [](CanFrame& f) { f.error = true; }, {}},
      {"29-bit number", "80000701#004E81FC80200147", nothing, {}},
      {"another sensor", "711#004E81FC80200147", nothing, {}},
      {"another device", "708#004E81FC80200147", nothing, {}},
      {"object header", "60A#03FBF710", nothing, {.frames = 1, .wrong_mode = 1}},
      {"object", "60B#384F04028020019C", nothing, {.frames = 1, .wrong_mode = 1}},
      {"object quality", "60C#3884A33A0220E8", nothing, {.frames = 1, .wrong_mode = 1}},
      {"object extended", "60D#387D0FA070801205", nothing, {.frames = 1, .wrong_mode = 1}},
      {"object warning", "60E#38050000", nothing, {.frames = 1, .wrong_mode = 1}},
  };
  for (const Row& row : rows) {
    INFO(row.name);
    Ars408Decoder decoder({});
    CanFrame frame = hex_frame(row.frame);
    row.spoil(frame);
    CHECK(decoder.decode(frame).kind == Kind::none);
    const DecoderCounters& counters = decoder.counters();
    CHECK(counters.frames == row.counters.frames);
    CHECK(counters.wrong_length == row.counters.wrong_length);
    CHECK(counters.wrong_kind == row.counters.wrong_kind);
    CHECK(counters.wrong_mode == row.counters.wrong_mode);
    CHECK(counters.state_frames == 0);
  }
}

TEST_CASE("Cluster frames are the wrong mode for an object radar") {
  Ars408Decoder decoder({.output = Ars408Output::objects});
  for (const char* frame : {"600#5024581110", "701#004E81FC80200147", "702#0508888671"}) {
    CHECK(decoder.decode(hex_frame(frame)).kind == Kind::none);
  }
  CHECK(decoder.counters().wrong_mode == 3);
}

TEST_CASE("Reports and details of objects are state, not parts of a scan") {
  Ars408Decoder decoder({.output = Ars408Output::objects});
  const std::vector<std::string> frames = {
      "201#4019000010F40000", "203#0810",     "204#0C003203E8", "402#484EEC135143EB04",
      "408#320AFBF7",         "700#041E0200", "60E#38050000",   "60D#387D0FA070801205"};
  for (const std::string& frame : frames) {
    INFO(frame);
    CHECK(decoder.decode(hex_frame(frame)).kind == Kind::none);
    check_sensor(hex_frame(frame), message_of(hex_frame(frame)).subject);
  }
  CHECK(decoder.counters().frames == frames.size());
  CHECK(decoder.counters().state_frames == frames.size());
}

TEST_CASE("The latest state is kept") {
  Ars408Decoder decoder({});
  CHECK_FALSE(decoder.radar_state().has_value());
  decoder.decode(hex_frame("201#4019000010F40000"));
  REQUIRE(decoder.radar_state().has_value());
  CHECK(decoder.radar_state()->output_code == 1);
  CHECK(decoder.radar_state()->sends_quality);
  CHECK(decoder.radar_state()->speed_missing);

  SECTION("a newer one replaces it") {
    decoder.decode(hex_frame("201#C01F400000080004"));
    CHECK(decoder.radar_state()->output_code == 2);
    CHECK_FALSE(decoder.radar_state()->sends_quality);
  }
  SECTION("a rejected one and another sensor's do not") {
    decoder.decode(hex_frame("201#C01F4000000800"));
    decoder.decode(hex_frame("211#C01F400000080004"));
    CHECK(decoder.radar_state()->output_code == 1);
  }
}

TEST_CASE("Each fault that the state reports is a fault of its health") {
  struct Row {
    const char* frame;
    std::uint32_t faults;
  };
  const std::vector<Row> rows = {
      {"201#0000000000000000", 0},
      {"201#0000200000000000", RadarHealth::persistent_error},
      {"201#0000100000000000", RadarHealth::interference},
      {"201#0000080000000000", RadarHealth::temperature_error},
      {"201#0000040000000000", RadarHealth::temporary_error},
      {"201#0000020000000000", RadarHealth::voltage_error},
      {"201#0000000000400000", RadarHealth::speed_missing},
      {"201#0000000000800000", RadarHealth::yaw_rate_missing},
  };
  for (const Row& row : rows) {
    INFO(row.frame);
    Ars408Decoder decoder({});
    decoder.decode(hex_frame(row.frame));
    CHECK(decoder.health().faults == row.faults);
  }
}

TEST_CASE("What only has the identifier of a state makes it unknown") {
  constexpr std::int64_t kSecondUs = 1'000'000;
  Ars408Decoder decoder({});
  decoder.decode(hex_frame("201#4019000010F40000", 0));
  CHECK(decoder.health().is_known);

  SECTION("it names another sensor") {
    decoder.decode(hex_frame("201#4019000013F40000", kSecondUs));
  }
  SECTION("it comes far more often, as of a GPR") {
    decoder.decode(hex_frame("201#4019000010F40000", kSecondUs / 10));
  }
  CHECK_FALSE(decoder.health().is_known);
  CHECK(decoder.counters().wrong_slot == 1);
  decoder.decode(hex_frame("201#4019000010F40000", 3 * kSecondUs));
  CHECK(decoder.health().is_known);
}

TEST_CASE("A frame that claims more bytes than it can hold is read within bounds") {
  Ars408Decoder decoder({});
  CanFrame frame = hex_frame("701#004E81FC80200147");
  frame.length = 255;
  CHECK(decoder.decode(frame).kind == Kind::target);
}

}  // namespace
}  // namespace cremed::test
