// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause

// Every command of the doctor that may send x traffic on the bus x source of consent: exactly the
// intended frames are sent. test/vm/test_doctor repeats rows of it with the program.
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "test/can_decoders/hex_frame.hpp"
#include "test/tools/ars408_talks.hpp"
#include "tools/doctor/ars408_filters.hpp"
#include "tools/doctor/ars408_setup.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

/// Traffic on the bus.
struct Bus {
  std::string name;
  std::vector<Ars408RadarState> states;
  Ars408Manners manners;
  bool has_gpr = false;
};

struct Command {
  std::string name;
  std::optional<std::uint8_t> said_id;
  std::function<TalkResult(const Ars408Talk&)> run;
  std::vector<std::string> frames;  ///< Frames to a sensor that answers and obeys.
};

/// Source of consent.
struct Person {
  std::string name;
  bool agrees;
  Input::Kind kind;
  std::string typed;
  bool is_given = false;
};

std::vector<Bus> buses() {
  return {{"the sensor", {factory_state(0)}, {}},
          {"one that is not to be had", {}, {}},
          {"a foreign one", {factory_state(5)}, {}},
          {"that of another radar", {factory_state(3)}, {}},
          {"several", {factory_state(0), factory_state(3)}, {}},
          {"several, one foreign", {factory_state(0), factory_state(5)}, {}},
          {"a silent one", {factory_state(0)}, {.falls_silent = true}},
          {"a refusing one", {factory_state(0)}, {.obeys = false}},
          {"a foreign one that refuses", {factory_state(5)}, {.obeys = false}},
          {"a GPR beside it", {factory_state(0)}, {}, true}};
}

std::vector<Command> commands() {
  const auto setup = [](const Ars408Setup& with) {
    return [with](const Ars408Talk& talk) { return set_up_ars408(talk, with); };
  };
  const auto filters = [](const std::vector<std::string>& texts) {
    return [texts](const Ars408Talk& talk) {
      std::vector<Ars408FilterState> wanted;
      for (const std::string& text : texts) {
        wanted.push_back(parse_ars408_filter(text).value());
      }
      return talk_about_filters(talk, wanted);
    };
  };
  const std::uint8_t five = 5;
  return {{"--configure-ars408", {}, setup({}), {"200#3A00000010040000"}},
          {"--store", {}, setup({.store = true}), {"200#BA00000010840000"}},
          {"--sensor-id 5", five, setup({.store = true}), {"250#BA00000010840000"}},
          {"--ars408-filters",
           {},
           filters({}),
           {"202#0000000000", "202#0800000000", "202#1000000000", "202#1800000000",
            "202#2000000000", "202#2800000000"}},
          {"--filter",
           {},
           filters({"range=5..100", "rcs=-10..30"}),
           {"202#0E003203E8", "202#2E06400C80"}}};
}

std::vector<Person> persons() {
  return {{"a person agrees", true, Input::Kind::terminal, "y\n"},
          {"a person does not", false, Input::Kind::terminal, "n\n"},
          {"nobody types", false, Input::Kind::terminal, ""},
          {"a pipe says yes", false, Input::Kind::pipe, "y\n"},
          {"standard input is closed", false, Input::Kind::closed, ""},
          {"--yes", true, Input::Kind::closed, "", true}};
}

bool is_there(const Bus& bus, std::uint8_t id) {
  return std::ranges::any_of(bus.states, [id](const auto& state) { return state.sensor_id == id; });
}

/// Expected: to the sensor with the configured id, or to the given id if the configured one is
/// free, never with a GPR on the bus; filters one by one, as long as each is confirmed.
std::vector<std::string> meant(const Command& command, const Bus& bus, const Person& person) {
  const std::uint8_t id = command.said_id.value_or(0);
  const bool takes_id_of_other = id != 0 && is_there(bus, 0);
  if (!person.agrees || bus.has_gpr || !is_there(bus, id) || takes_id_of_other) {
    return {};
  }
  const bool is_filter = command.frames[0].starts_with("202");
  const bool is_set = command.name == "--filter";
  const bool stops = bus.manners.falls_silent || (is_set && !bus.manners.obeys);
  return is_filter && stops ? std::vector{command.frames[0]} : command.frames;
}

std::vector<CanFrame> gpr_frames() {
  std::vector<CanFrame> frames;
  for (std::uint32_t i = 0; i < 96; ++i) {
    frames.push_back({.id = 0x200 + i, .length = 8});
  }
  return frames;
}

std::vector<CanFrame> sent(const Command& command, const Bus& bus, const Person& person) {
  FakeArs408s sensors(bus.states, bus.manners,
                      bus.has_gpr ? gpr_frames() : std::vector<CanFrame>{});
  const Configuration configuration = two_ars408s();
  const Input input(person.kind, person.typed);
  Ars408TalkOptions options = quick_talk(bus.manners);
  options.address.said_id = command.said_id;
  options.consent = {person.is_given, input.descriptor()};
  std::ostringstream out;
  const TalkResult result =
      command.run({configuration, configuration.radars[0], options, sensors.socket(), out});
  const std::vector<CanFrame> frames = sensors.all_received();
  CAPTURE(out.str());
  CHECK((result == TalkResult::not_sent) == frames.empty());
  CHECK((out.str().find("nothing was sent") != std::string::npos) == frames.empty());
  return frames;
}

}  // namespace

TEST_CASE("Exactly the frames that are meant are sent") {
  for (const Command& command : commands()) {
    for (const Bus& bus : buses()) {
      for (const Person& person : persons()) {
        CAPTURE(command.name, bus.name, person.name);
        const std::vector<std::string> expected = meant(command, bus, person);
        const std::vector<CanFrame> frames = sent(command, bus, person);
        REQUIRE(frames.size() == expected.size());
        for (std::size_t i = 0; i < frames.size(); ++i) {
          const CanFrame wanted = hex_frame(expected[i]);
          CHECK(frames[i].id == wanted.id);
          CHECK(frames[i].length == wanted.length);
          CHECK(frames[i].data == wanted.data);
        }
      }
    }
  }
}

TEST_CASE("A bus that is standard input gives no consent") {
  FakeArs408s sensors({factory_state(0)}, {}, {{.id = 0x79, .length = 2, .data = {'y', '\n'}}});
  const Configuration configuration = two_ars408s();
  Ars408TalkOptions options = quick_talk({});
  options.consent.terminal = sensors.socket().descriptor();
  std::ostringstream out;
  CHECK(set_up_ars408({configuration, configuration.radars[0], options, sensors.socket(), out},
                      {}) == TalkResult::not_sent);
  CHECK(sensors.all_received().empty());
  CHECK_THAT(out.str(), Catch::Contains("add --yes to give consent"));
}
