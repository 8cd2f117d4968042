// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "test/can_decoders/hex_frame.hpp"
#include "test/tools/ars408_talks.hpp"
#include "tools/doctor/ars408_filters.hpp"

using namespace cremed;
using namespace cremed::test;

namespace {

struct FilterTalk {
  TalkResult result;
  std::string text;
  std::vector<std::string> sent;
};

std::string hex(const CanFrame& frame) {
  std::ostringstream text;
  text << std::hex << std::uppercase << frame.id << '#';
  for (std::size_t i = 0; i < frame.length; ++i) {
    text << (frame.data[i] >> 4U) << (frame.data[i] & 15U);
  }
  return text.str();
}

FilterTalk talk(const Ars408Manners& manners, const std::vector<std::string>& wanted) {
  FakeArs408s sensors({factory_state(0)}, manners, {});
  const Configuration configuration = two_ars408s();
  const Input input(Input::Kind::terminal, "y\n");
  Ars408TalkOptions options = quick_talk(manners);
  options.consent.terminal = input.descriptor();
  std::vector<Ars408FilterState> filters;
  for (const std::string& text : wanted) {
    filters.push_back(parse_ars408_filter(text).value());
  }
  std::ostringstream out;
  const TalkResult result = talk_about_filters(
      {configuration, configuration.radars[0], options, sensors.socket(), out}, filters);
  FilterTalk outcome{result, out.str(), {}};
  for (const CanFrame& frame : sensors.all_received()) {
    outcome.sent.push_back(hex(frame));
  }
  return outcome;
}

}  // namespace

TEST_CASE("Filters are asked for one after the other, and nothing is changed") {
  const FilterTalk outcome = talk({}, {});
  CAPTURE(outcome.text);
  CHECK(outcome.result == TalkResult::took);
  CHECK(outcome.sent == std::vector<std::string>{"202#0000000000", "202#0800000000",
                                                 "202#1000000000", "202#1800000000",
                                                 "202#2000000000", "202#2800000000"});
  CHECK_THAT(outcome.text, Catch::Contains("can0 202#2800000000\n"));
  CHECK_THAT(outcome.text, Catch::EndsWith("  departing: off\n  rcs: off\n"));
}

TEST_CASE("Filters are set, each once, and read back") {
  const FilterTalk outcome = talk({}, {"range=5..100", "rcs=-10..30", "rcs=off"});
  CAPTURE(outcome.text);
  CHECK(outcome.result == TalkResult::took);
  CHECK(outcome.sent ==
        std::vector<std::string>{"202#0E003203E8", "202#2E06400C80", "202#2A07D007D0"});
  CHECK_THAT(outcome.text, Catch::Contains("in its flash, which wears"));
  CHECK_THAT(outcome.text, Catch::Contains("  range: 5 to 100 m, set\n"));
  CHECK_THAT(outcome.text, Catch::Contains("  rcs: -10 to 30 dBm^2, set\n"));
  CHECK_THAT(outcome.text, Catch::EndsWith("  rcs: off, set\n"));
}

TEST_CASE("After a filter that does not take nothing more is sent") {
  const FilterTalk refused = talk({.obeys = false}, {"range=5..100", "rcs=-10..30"});
  CHECK(refused.result == TalkResult::not_taken);
  CHECK(refused.sent.size() == 1);
  CHECK_THAT(refused.text, Catch::EndsWith("  range: off, not set: expected range: 5 to 100 m\n"));
  const FilterTalk silent = talk({.falls_silent = true}, {});
  CHECK(silent.result == TalkResult::not_taken);
  CHECK(silent.sent.size() == 1);
  CHECK_THAT(silent.text, Catch::EndsWith("no 0x204 came after it: the sensor does not answer\n"));
}

TEST_CASE("Filters that were written to flash are named when a later one fails") {
  const FilterTalk outcome =
      talk({.filters_taken = 2}, {"range=5..100", "rcs=-10..30", "count=0..90", "azimuth=-9..9"});
  CHECK(outcome.result == TalkResult::not_taken);
  CHECK(outcome.sent.size() == 3);
  CHECK_THAT(outcome.text,
             Catch::EndsWith("already in its flash: range: 5 to 100 m; rcs: -10 to 30 dBm^2\n"));
}

TEST_CASE("How filters are worded") {
  const auto round_trip = [](const std::string& text) {
    const auto filter = parse_ars408_filter(text);
    return filter ? to_text(*filter) : "none";
  };
  CHECK(round_trip("count=0..100") == "count: 0 to 100");
  CHECK(round_trip("range=0.2..70") == "range: 0.2 to 70 m");
  CHECK(round_trip("azimuth=-9.5..45") == "azimuth: -9.5 to 45 deg");
  CHECK(round_trip("oncoming=0..100") == "oncoming: 0 to 100 m/s");
  CHECK(round_trip("departing=off") == "departing: off");
  const auto bad =
      GENERATE(as<std::string>{}, "", "=", "range", "range=", "range=5", "range=5..", "range=..5",
               "range=7..5", "range=a..5", "range=1..5m", "range=-1..5", "range=0..410",
               "azimuth=-51..5", "rcs=-5..nan", "rcs=-inf..5", "size=0..5", "Range=0..5");
  CAPTURE(bad);
  CHECK(round_trip(bad) == "none");
}
