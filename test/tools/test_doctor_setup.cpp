// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "test/can_decoders/hex_frame.hpp"
#include "test/tools/ars408_talks.hpp"
#include "tools/doctor/ars408_setup.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

struct SetupTalk {
  TalkResult result;
  std::string text;
  std::vector<CanFrame> sent;
};

/// The user's command line and input.
struct Said {
  Ars408Setup setup{};
  Ars408Address address{};
  std::string typed = "y\n";
};

SetupTalk set_up(const std::vector<Ars408RadarState>& states, const Ars408Manners& manners,
                 const Said& said, const Configuration& configuration = two_ars408s(),
                 const std::vector<CanFrame>& traffic = {}) {
  FakeArs408s sensors(states, manners, traffic);
  const Input input(Input::Kind::terminal, said.typed);
  Ars408TalkOptions options = quick_talk(manners);
  options.address.said_id = said.address.said_id;
  options.consent.terminal = input.descriptor();
  std::ostringstream out;
  const TalkResult result = set_up_ars408(
      {configuration, configuration.radars[0], options, sensors.socket(), out}, said.setup);
  return {result, out.str(), sensors.all_received()};
}

/// Text that tells when the user is asked.
class WhenFlushed final : public std::stringbuf {
 public:
  explicit WhenFlushed(std::function<void()> then) : then_(std::move(then)) {}

 private:
  int sync() override {
    then_();
    return 0;
  }
  std::function<void()> then_;
};

void check_sent(const SetupTalk& outcome, const std::string& expected) {
  CAPTURE(outcome.text);
  const CanFrame frame = hex_frame(expected);
  REQUIRE(outcome.sent.size() == 1);
  CHECK(outcome.sent[0].id == frame.id);
  CHECK(outcome.sent[0].data == frame.data);
  CHECK_THAT(outcome.text, Catch::Contains("can0 " + expected + "\n"));
}

}  // namespace

TEST_CASE("A sensor is set to clusters with quality, and confirms it") {
  const SetupTalk outcome = set_up({factory_state(0)}, {}, {});
  CHECK(outcome.result == TalkResult::took);
  check_sent(outcome, "200#3A00000010040000");
  CHECK_THAT(outcome.text, Catch::Contains("output: objects -> clusters"));
  CHECK_THAT(outcome.text, Catch::Contains("extended: on -> off"));
  CHECK_THAT(outcome.text, Catch::Contains("--store keeps it"));
  CHECK_THAT(outcome.text, Catch::Contains("output: clusters, set"));
  CHECK_THAT(outcome.text, Catch::Contains("extended: off, set"));
}

TEST_CASE("Nothing is sent unless the user says yes") {
  const auto answer = GENERATE(as<std::string>{}, "", "\n", "n\n", "no\n", "maybe\n", "Yup\n");
  CAPTURE(answer);
  const SetupTalk outcome = set_up({factory_state(0)}, {}, {.typed = answer});
  CHECK(outcome.result == TalkResult::not_sent);
  CHECK(outcome.sent.empty());
  CHECK_THAT(outcome.text, Catch::Contains("[y/N]"));
  CHECK_THAT(outcome.text, Catch::EndsWith("nothing was sent\n"));
}

TEST_CASE("Range and storing are set only if asked for") {
  const SetupTalk outcome =
      set_up({factory_state(0)}, {}, {.setup = {.max_distance_m = 249.0, .store = true}});
  CHECK(outcome.result == TalkResult::took);
  check_sent(outcome, "200#BB1F400010840000");
  CHECK_THAT(outcome.text, Catch::Contains("flash, which wears"));
  CHECK_THAT(outcome.text, Catch::Contains("range: 250 m, set"));
  CHECK_THAT(outcome.text, Catch::Contains("stored: yes, set"));
}

TEST_CASE("A sensor with another id is addressed by that, and confirms under the new one") {
  const SetupTalk outcome =
      set_up({factory_state(5), factory_state(3)}, {}, {.address = {.said_id = std::uint8_t{5}}});
  CHECK(outcome.result == TalkResult::took);
  check_sent(outcome, "250#3A00000010040000");
  CHECK_THAT(outcome.text, Catch::Contains("front: ARS408 with sensor id 5 on can0"));
  CHECK_THAT(outcome.text, Catch::Contains("sensor id: 5 -> 0"));
  CHECK_THAT(outcome.text, Catch::Contains("sensor id: 0, set"));
}

TEST_CASE("A radar that is to send objects is set to objects") {
  Ars408RadarState state = factory_state(0);
  state.output_code = 2;
  const SetupTalk outcome = set_up({state}, {}, {}, two_ars408s(Ars408Output::objects));
  CHECK(outcome.result == TalkResult::took);
  check_sent(outcome, "200#3A00000008040000");
}

TEST_CASE("What did not take is named") {
  struct Case {
    Ars408Manners manners;
    std::uint8_t sensor_id;
    std::string text;
  };
  const auto row =
      GENERATE(Case{{.keeps_range = true}, 0, "range: 200 m, not set: expected 260 m"},
               Case{{.obeys = false}, 0, "output: objects, not set: expected clusters"},
               Case{{.obeys = false}, 5, "sensor id: 5, not set: expected 0"},
               Case{{.falls_silent = true}, 0, "no 0x201 came after it"});
  CAPTURE(row.text);
  const SetupTalk outcome =
      set_up({factory_state(row.sensor_id)}, row.manners,
             {.setup = {.max_distance_m = 260.0}, .address = {.said_id = row.sensor_id}});
  CHECK(outcome.result == TalkResult::not_taken);
  CHECK(outcome.sent.size() == 1);
  CHECK_THAT(outcome.text, Catch::Contains(row.text));
}

TEST_CASE("A sensor that is set as wanted is left alone, unless it has not stored it and is to") {
  Ars408RadarState state = factory_state(0);
  state.output_code = 2;
  state.sends_extended = false;
  const SetupTalk outcome = set_up({state}, {}, {});
  CHECK(outcome.result == TalkResult::took);
  CHECK(outcome.sent.empty());
  CHECK_THAT(outcome.text, Catch::Contains("It already has these settings"));
  CHECK(set_up({state}, {}, {.setup = {.store = true}}).sent.size() == 1);
  state.nvm_written = true;
  const SetupTalk repeated = set_up({state}, {}, {.setup = {.store = true}});
  CHECK(repeated.result == TalkResult::took);
  CHECK(repeated.sent.empty());
  CHECK_THAT(repeated.text, Catch::Contains("in its flash too; nothing was sent"));
  CHECK(set_up({state}, {}, {.setup = {.max_distance_m = 250.0, .store = true}}).sent.size() == 1);
}

TEST_CASE("What came while the user was asked confirms nothing") {
  FakeArs408s sensors({factory_state(0)}, {.obeys = false}, {});
  const Configuration configuration = two_ars408s();
  const Input input(Input::Kind::terminal, "y\n");
  Ars408TalkOptions options = quick_talk({.obeys = false});
  options.consent.terminal = input.descriptor();
  WhenFlushed prompt([&] { sensors.send(encode_ars408(0, good_state())); });
  std::ostream out(&prompt);
  const TalkResult result =
      set_up_ars408({configuration, configuration.radars[0], options, sensors.socket(), out}, {});
  CAPTURE(prompt.str());
  CHECK(result == TalkResult::not_taken);
  CHECK(sensors.all_received().size() == 1);
}

TEST_CASE("Nothing is sent where it is not certain which sensor is meant") {
  struct Case {
    std::string name;
    std::vector<Ars408RadarState> states;
    std::optional<std::uint8_t> said_id;
    std::string text;
  };
  Ars408RadarState other = factory_state(0);
  other.max_distance_m = 260.0;
  const std::uint8_t three = 3;
  const std::uint8_t five = 5;
  const auto row = GENERATE_COPY(
      Case{"no sensor", {}, {}, "no 0x201 of an ARS408 with sensor id 0 on can0"},
      Case{"another id",
           {factory_state(5)},
           {},
           "but with 5; if that is \"front\", say so: "
           "--sensor-id 5; nothing was sent"},
      Case{"only that of another radar", {factory_state(3)}, {}, "no 0x201 of an ARS408 with"},
      Case{"that of another radar, said", {factory_state(3)}, three, "is radar \"left\""},
      Case{"two unknown", {factory_state(1), factory_state(6)}, {}, "but with 1, 6"},
      Case{"said, but not there", {factory_state(0)}, five, "with sensor id 5 on can0, but with 0"},
      Case{"it would get an id twice",
           {factory_state(0), factory_state(5)},
           five,
           "sensor id 0, which it would get, is on can0 too"},
      Case{"two with one id", {factory_state(0), other}, {}, "two sensors with id 0"});
  CAPTURE(row.name);
  const SetupTalk outcome = set_up(row.states, {}, {.address = {.said_id = row.said_id}});
  CAPTURE(outcome.text);
  CHECK(outcome.result == TalkResult::not_sent);
  CHECK(outcome.sent.empty());
  CHECK_THAT(outcome.text, Catch::Contains(row.text));
  CHECK_THAT(outcome.text, Catch::Contains("nothing was sent"));
}

TEST_CASE("Nothing is sent to what is no ARS408") {
  std::vector<CanFrame> gpr;
  for (std::uint32_t i = 0; i < 96; ++i) {
    gpr.push_back({.id = 0x200 + i, .length = 8});
  }
  const SetupTalk among = set_up({factory_state(0)}, {}, {}, two_ars408s(), gpr);
  CHECK(among.sent.empty());
  CHECK_THAT(among.text, Catch::Contains("a Bosch GPR is on can0"));
  // A report whose sensor id contradicts its identifier comes from another device.
  const SetupTalk stranger = set_up({}, {}, {}, two_ars408s(), {hex_frame("201#4019000013F40000")});
  CHECK(stranger.sent.empty());
  CHECK_THAT(stranger.text, Catch::Contains("no 0x201 of an ARS408 with sensor id 0 on can0"));
}

TEST_CASE("Two sensors that are set alike are told by how often their id reports") {
  FakeArs408s sensors({factory_state(0)}, {}, {});
  const Configuration configuration = two_ars408s();
  Ars408TalkOptions options = quick_talk({});
  options.consent.is_given = true;
  options.address.shortest_three_us = 100'000'000;
  options.listen_us = 500'000;
  std::ostringstream out;
  CHECK(set_up_ars408({configuration, configuration.radars[0], options, sensors.socket(), out},
                      {}) == TalkResult::not_sent);
  CHECK(sensors.all_received().empty());
  CHECK_THAT(out.str(), Catch::Contains("two sensors with id 0 seem to be on can0"));
}

TEST_CASE("A report that comes late is not of a second sensor") {
  constexpr std::int64_t kSecondUs = 1'000'000;
  const auto late_us = GENERATE(300'000, 450'000);
  const auto second = GENERATE(range(0, 6));
  Ars408States states;
  for (int i = 0; i < 7; ++i) {
    CanFrame report = encode_ars408(0, good_state());
    report.stamp_us = i * kSecondUs + (i == second ? late_us : 0);
    note_state(report, states);
  }
  const Configuration configuration = two_ars408s();
  const auto bus = std::make_unique<BusObservation>();
  const Ars408Search found = find_ars408(configuration, configuration.radars[0], {}, *bus, states);
  CHECK(found.problem.empty());
  CHECK(found.sensor_id == 0);
}

TEST_CASE("Of two sensors with one id, one may report every 5 s only") {
  constexpr std::int64_t kSecondUs = 1'000'000;
  const Ars408TalkOptions options;
  const Configuration configuration = two_ars408s();
  const std::int64_t phase_us = GENERATE(range(std::int64_t{0}, 5 * kSecondUs, kSecondUs / 10));
  Ars408States states;
  for (std::int64_t us = kSecondUs / 20; us < options.listen_us; us += kSecondUs / 20) {
    if (us % kSecondUs == kSecondUs / 20 || us % (5 * kSecondUs) == phase_us) {
      CanFrame report = encode_ars408(0, good_state());
      report.stamp_us = us;
      note_state(report, states);
    }
  }
  const auto bus = std::make_unique<BusObservation>();
  CHECK_THAT(
      find_ars408(configuration, configuration.radars[0], options.address, *bus, states).problem,
      Catch::Contains("two sensors with id 0"));
}
