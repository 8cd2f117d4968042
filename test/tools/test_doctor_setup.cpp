// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "test/can_decoders/hex_frame.hpp"
#include "test/tools/fake_ars408.hpp"
#include "tools/doctor/ars408_setup.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

Configuration two_ars408s(Ars408Output output = Ars408Output::clusters) {
  Configuration configuration;
  for (const std::uint8_t sensor : {std::uint8_t{0}, std::uint8_t{3}}) {
    RadarConfiguration radar;
    radar.name = sensor == 0 ? "front" : "left";
    radar.interface = "can0";
    radar.decoder = Ars408Options{.sensor_id = sensor, .output = output};
    configuration.radars.push_back(radar);
  }
  return configuration;
}

/// As a sensor comes from the factory: objects, with all that belongs to them.
Ars408RadarState factory_state(std::uint8_t sensor_id) {
  Ars408RadarState state;
  state.sensor_id = sensor_id;
  state.output_code = 1;
  state.sends_quality = true;
  state.sends_extended = true;
  state.max_distance_m = 200.0;
  return state;
}

struct Outcome {
  SetupResult result;
  std::string text;
  std::vector<CanFrame> sent;
};

Outcome set_up(const std::vector<Ars408RadarState>& states, const Ars408Manners& manners,
               Ars408Setup setup, const std::string& answer,
               const Configuration& configuration = two_ars408s(),
               const std::vector<CanFrame>& traffic = {}) {
  FakeArs408s sensors(states, manners, traffic);
  setup.listen_us = 60'000;
  setup.confirm_us = 300'000;
  std::istringstream answers(answer);
  std::ostringstream out;
  const SetupResult result =
      set_up_ars408(configuration, configuration.radars[0], setup, sensors.socket(), answers, out);
  return {result, out.str(), sensors.received()};
}

void check_sent(const Outcome& outcome, const std::string& expected) {
  CAPTURE(outcome.text);
  const CanFrame frame = hex_frame(expected);
  REQUIRE(outcome.sent.size() == 1);
  CHECK(outcome.sent[0].id == frame.id);
  CHECK(outcome.sent[0].data == frame.data);
  CHECK_THAT(outcome.text, Catch::Contains("can0 " + expected + "\n"));
}

}  // namespace

TEST_CASE("A sensor is set to clusters with quality, and confirms it") {
  const Outcome outcome = set_up({factory_state(0)}, {}, {}, "y\n");
  CHECK(outcome.result == SetupResult::took);
  check_sent(outcome, "200#3A00000010040000");
  CHECK_THAT(outcome.text, Catch::Contains("output: objects -> clusters"));
  CHECK_THAT(outcome.text, Catch::Contains("extended: on -> off"));
  CHECK_THAT(outcome.text, Catch::Contains("--store keeps it"));
  CHECK_THAT(outcome.text, Catch::Contains("output: clusters, took"));
  CHECK_THAT(outcome.text, Catch::Contains("extended: off, took"));
}

TEST_CASE("Nothing is sent unless the user says yes") {
  const auto answer = GENERATE(as<std::string>{}, "", "\n", "n\n", "no\n", "maybe\n", "Yup\n");
  CAPTURE(answer);
  const Outcome outcome = set_up({factory_state(0)}, {}, {}, answer);
  CHECK(outcome.result == SetupResult::not_sent);
  CHECK(outcome.sent.empty());
  CHECK_THAT(outcome.text, Catch::Contains("[y/N]"));
  CHECK_THAT(outcome.text, Catch::EndsWith("nothing was sent\n"));
}

TEST_CASE("A script that has agreed is not asked") {
  const Outcome outcome = set_up({factory_state(0)}, {}, {.is_agreed = true}, "");
  CHECK(outcome.result == SetupResult::took);
  CHECK(outcome.sent.size() == 1);
  CHECK_THAT(outcome.text, !Catch::Contains("[y/N]"));
}

TEST_CASE("Range and storing are set only if asked for") {
  const Outcome outcome =
      set_up({factory_state(0)}, {}, {.max_distance_m = 249.0, .store = true}, "y\n");
  CHECK(outcome.result == SetupResult::took);
  check_sent(outcome, "200#BB1F400010840000");
  CHECK_THAT(outcome.text, Catch::Contains("flash, which wears"));
  CHECK_THAT(outcome.text, Catch::Contains("range: 250 m, took"));
  CHECK_THAT(outcome.text, Catch::Contains("stored: yes, took"));
}

TEST_CASE("A sensor with another id is addressed by that, and confirms under the new one") {
  const Outcome outcome = set_up({factory_state(5), factory_state(3)}, {}, {}, "y\n");
  CHECK(outcome.result == SetupResult::took);
  check_sent(outcome, "250#3A00000010040000");
  CHECK_THAT(outcome.text, Catch::Contains("front: ARS408 with sensor id 5 on can0"));
  CHECK_THAT(outcome.text, Catch::Contains("sensor id: 5 -> 0"));
  CHECK_THAT(outcome.text, Catch::Contains("sensor id: 0, took"));
}

TEST_CASE("A radar that is to send objects is set to objects") {
  Ars408RadarState state = factory_state(0);
  state.output_code = 2;
  const Outcome outcome = set_up({state}, {}, {}, "y\n", two_ars408s(Ars408Output::objects));
  CHECK(outcome.result == SetupResult::took);
  check_sent(outcome, "200#3A00000008040000");
}

TEST_CASE("What did not take is named") {
  struct Case {
    Ars408Manners manners;
    std::uint8_t sensor_id;
    std::string text;
  };
  const auto row =
      GENERATE(Case{{.keeps_range = true}, 0, "range: 200 m, did not take: wanted 260 m"},
               Case{{.obeys = false}, 0, "output: objects, did not take: wanted clusters"},
               Case{{.obeys = false}, 5, "sensor id: 5, did not take: wanted 0"},
               Case{{.falls_silent = true}, 0, "no 0x201 came after it"});
  CAPTURE(row.text);
  const Outcome outcome =
      set_up({factory_state(row.sensor_id)}, row.manners, {.max_distance_m = 260.0}, "y\n");
  CHECK(outcome.result == SetupResult::not_taken);
  CHECK(outcome.sent.size() == 1);
  CHECK_THAT(outcome.text, Catch::Contains(row.text));
}

TEST_CASE("A sensor that is set as wanted is left alone, unless it is to store it") {
  Ars408RadarState state = factory_state(0);
  state.output_code = 2;
  state.sends_extended = false;
  const Outcome outcome = set_up({state}, {}, {.is_agreed = true}, "");
  CHECK(outcome.result == SetupResult::took);
  CHECK(outcome.sent.empty());
  CHECK_THAT(outcome.text, Catch::Contains("It is set so already"));
  CHECK(set_up({state}, {}, {.store = true, .is_agreed = true}, "").sent.size() == 1);
}

TEST_CASE("Nothing is sent where it is not certain which sensor is meant") {
  struct Case {
    std::string name;
    std::vector<Ars408RadarState> states;
    std::vector<CanFrame> traffic;
    std::string text;
  };
  std::vector<CanFrame> gpr;
  for (std::uint32_t i = 0; i < 96; ++i) {
    gpr.push_back({.id = 0x200 + i, .length = 8});
  }
  // A report whose sensor id is not that of its identifier is from something else.
  const CanFrame stranger = hex_frame("221#4019000010F40000");
  const auto row = GENERATE_COPY(
      Case{"no sensor", {}, {}, "no 0x201 of an ARS408 on can0"},
      Case{"only that of another radar", {factory_state(3)}, {}, "no 0x201 of an ARS408 on can0"},
      Case{"two unknown", {factory_state(1), factory_state(6)}, {}, "sensor ids 1, 6 are on can0"},
      Case{"a GPR", {factory_state(0)}, gpr, "a Bosch GPR is on can0"},
      Case{"something else", {}, {stranger}, "no 0x201 of an ARS408 on can0"});
  CAPTURE(row.name);
  const Outcome outcome =
      set_up(row.states, {}, {.is_agreed = true}, "", two_ars408s(), row.traffic);
  CHECK(outcome.result == SetupResult::not_sent);
  CHECK(outcome.sent.empty());
  CHECK_THAT(outcome.text, Catch::Contains(row.text));
  CHECK_THAT(outcome.text, Catch::Contains("nothing was sent"));
}
