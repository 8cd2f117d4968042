// SPDX-FileCopyrightText: 2026 the cremed authors
// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "cremed/can_decoders/bosch_gpr.hpp"
#include "daemon/configuration/interfaces.hpp"
#include "daemon/configuration/radar_identifiers.hpp"
#include "daemon/configuration/radar_place.hpp"
#include "test/daemon/configuration_texts.hpp"

using namespace cremed;

namespace {

RadarConfiguration radar(const std::string& name, const std::string& interface,
                         const RadarSettings& decoder) {
  RadarConfiguration radar;
  radar.name = name;
  radar.interface = interface;
  radar.decoder = decoder;
  return radar;
}

HeardBus silent(const std::string& interface) {
  HeardBus bus;
  bus.interface = interface;
  return bus;
}

HeardBus with_ars408(const std::string& interface, std::uint32_t sensor_id) {
  HeardBus bus = silent(interface);
  bus.traffic.add({.id = 0x600 + 0x10 * sensor_id, .length = 5});
  return bus;
}

HeardBus with_gpr(const std::string& interface, std::uint32_t base_id) {
  HeardBus bus = silent(interface);
  for (std::uint32_t i = 0; i < kGprTargetIds; ++i) {
    bus.traffic.add({.id = base_id + i, .length = 8});
  }
  return bus;
}

Configuration configuration_of(const std::vector<RadarConfiguration>& radars) {
  Configuration configuration;
  configuration.radars = radars;
  return configuration;
}

}  // namespace

TEST_CASE("Swapped adapters do not matter: each radar is where it shows itself") {
  const std::vector<HeardBus> buses = {silent("can2"), with_gpr("can0", 0x200),
                                       with_ars408("can1", 0)};
  Configuration configuration = configuration_of(
      {radar("front", "auto", Ars408Options{}), radar("rear", "auto", BoschGprOptions{})});
  const auto places = find_interfaces(buses, configuration);
  REQUIRE(places.size() == 2);
  CHECK(places[0].status == PlaceStatus::found);
  CHECK(configuration.radars[0].interface == "can1");
  CHECK(places[1].interface == "can0");
  CHECK(configuration.radars[1].interface == "can0");
  CHECK(find_interfaces(buses, configuration).empty());
}

TEST_CASE("A radar that is nowhere is waited for, and what is there is told") {
  Configuration configuration = configuration_of({radar("front", "auto", Ars408Options{})});
  const auto places = find_interfaces({with_ars408("can0", 3), silent("can1")}, configuration);
  REQUIRE(places.size() == 1);
  CHECK(places[0].status == PlaceStatus::absent);
  CHECK(
      places[0].problem ==
      "no CAN interface shows an ARS408 with sensor id 0 (can0: an ARS408 with sensor id 3; can1: "
      "no radar)");
  CHECK(configuration.radars[0].interface == "auto");
  CHECK_THAT(find_interfaces({}, configuration).at(0).problem,
             Catch::Contains("(no CAN interface is up)"));
}

TEST_CASE("Two interfaces that show one radar are refused") {
  Configuration configuration = configuration_of({radar("front", "auto", Ars408Options{})});
  const auto place =
      find_interfaces({with_ars408("can0", 0), with_ars408("can1", 0)}, configuration).at(0);
  CHECK(place.status == PlaceStatus::ambiguous);
  CHECK(place.problem == "an ARS408 with sensor id 0 is on can0 and on can1");
  CHECK(place.remedy == "set interface to one of them for radar \"front\"");
  CHECK(configuration.radars[0].interface == "auto");
}

TEST_CASE("A radar is not put where another uses its identifiers") {
  Configuration configuration = configuration_of(
      {radar("rear", "can0", BoschGprOptions{}), radar("front", "auto", Ars408Options{})});
  const auto place = find_interfaces({with_ars408("can0", 0)}, configuration).at(0);
  CHECK(place.status == PlaceStatus::clash);
  CHECK(place.problem ==
        "an ARS408 with sensor id 0 is on can0, where radar \"rear\" uses CAN identifier 0x200 as "
        "well");
}

TEST_CASE("A radar whose interface is to be found has an entry of its own") {
  const Configuration configuration = configuration_of(
      {radar("a", "auto", Ars408Options{}), radar("b", "can0", Ars408Options{.sensor_id = 1}),
       radar("c", "auto", Ars408Options{.sensor_id = 2}),
       radar("d", "can0", Ars408Options{.sensor_id = 3})});
  CHECK(interface_names(configuration) == std::vector<std::string>{"auto", "can0", "auto"});
  CHECK(interfaces_of(configuration).of_radars[0] == 0);
  CHECK(interfaces_of(configuration).of_radars[2] == 2);
  CHECK(interfaces_of(configuration).of_radars[3] == 1);
  CHECK(ids_on(0, configuration).count() == kArs408Messages.size());
  CHECK(ids_on(1, configuration).count() == 2 * kArs408Messages.size());
  CHECK_THROWS_WITH(
      require_interface_names(configuration),
      Catch::StartsWith("radar \"a\": interface = \"auto\" is for live buses; must be "
                        "the name in the log"));
  CHECK_NOTHROW(require_interface_names(configuration_of({configuration.radars[1]})));
}

TEST_CASE("Two radars that are alike cannot be told apart, so their interfaces must be written") {
  const std::string front = radar_text("front", "ars408", "auto");
  for (const char* interface : {"auto", "can0"}) {
    CHECK(message_of(front + radar_text("left", "ars408", interface))
              .find("radar.interface: is \"auto\", but radars \"front\" and \"left\" are both an "
                    "ARS408 "
                    "with sensor id 0; must be the name of an interface for both") !=
          std::string::npos);
  }
  CHECK(message_of(front + radar_text("left", "ars408", "auto") + "sensor_id = 1\n") == "accepted");
  CHECK(message_of(front + radar_text("left", "bosch_gpr", "auto")) == "accepted");
  CHECK_THAT(message_of(front), Catch::Equals("accepted"));
}
